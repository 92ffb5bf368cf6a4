// What this tab may do with the machine just now.
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { mayAs, mayTryStop, session } from "../../rpc/session.ts";
import { type OneButton, oneButton } from "../../run/button_rules.ts";
import { partIdProblem } from "../../run/part_ids.ts";
import { partId, recipeChoice, recipes } from "./run_state.ts";

// The recipe that a start would name: what was chosen, else the prepared one, else that of the latest job.
export function recipeOf(choice: string | null, known: readonly string[] | null): string {
  const { state, job } = topics.get();
  const wanted = [choice, state?.recipe, job?.recipe].filter((id): id is string => Boolean(id));
  return wanted.find((id) => known === null || known.includes(id)) ?? known?.[0] ?? "";
}

export function useRecipeId(): string {
  useStore(topics);
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
  return buttonNow();
}
