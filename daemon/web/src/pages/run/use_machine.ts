// What this tab may do with the machine just now.
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { mayAs, mayTryStop, session } from "../../rpc/session.ts";
import { type OneButton, oneButton } from "../../run/button_rules.ts";
import { partIdProblem } from "../../run/part_ids.ts";
import { recipeToStart } from "../../run/recipe_choice.ts";
import { partId, recentRecipes, recipeChoice, recipes } from "./run_state.ts";

export function recipeOf(choice: string | null, known: readonly string[] | null): string {
  const { state, job } = topics.get();
  return recipeToStart({ choice, prepared: state?.recipe, measured: [job?.recipe ?? "", ...recentRecipes.get()], known });
}

export function useRecipeId(): string {
  useStore(topics);
  useStore(recentRecipes);
  return recipeOf(useStore(recipeChoice), useStore(recipes));
}

// As now(), for who is not a component.
export function buttonNow(): OneButton {
  const { state, control } = topics.get();
  const { who, role } = session.get();
  return oneButton({
    isLinked: link.get().status === "open",
    state,
    mayOperate: mayAs(role, "operate"),
    mayTryStop: mayTryStop(role),
    hasAnotherControl: control !== null && control.owner !== "" && control.who !== who,
    partProblem: partIdProblem(partId.get()),
    hasRecipe: recipeOf(recipeChoice.get(), recipes.get()) !== "",
  });
}

export function useButton(): OneButton {
  useStore(topics);
  useStore(session);
  useStore(link);
  useStore(partId);
  useStore(recipeChoice);
  useStore(recipes);
  useStore(recentRecipes);
  return buttonNow();
}
