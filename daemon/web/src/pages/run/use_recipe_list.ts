// The recipes that may be chosen, asked for as the page is opened and after each reconnection.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { link, resyncs } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { look } from "../../rpc/look.ts";
import { recipes } from "./run_state.ts";

// Why the list is not known.
export function useRecipeList(): string {
  const [problem, setProblem] = useState("");
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  useEffect(() => {
    if (!isLinked) return;
    let ended = false;
    look("recipe.list", {}).then((list) => {
      if (ended) return;
      recipes.set(list.recipes as string[]);
      setProblem("");
    }, (error: unknown) => ended || setProblem(messageOf(error)));
    return () => {
      ended = true;
      // A recipe that is saved and chosen from now on is not in it, and another one would be started in its place.
      recipes.set(null);
    };
  }, [count, isLinked]);
  return problem;
}
