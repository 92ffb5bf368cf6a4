// A recipe's document, fetched anew when it may have changed.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { link, resyncs, topics } from "../../live/live.ts";
import { look } from "../../rpc/look.ts";

export function useRecipe(id: string): unknown {
  const [held, setHeld] = useState<{ id: string; recipe: unknown }>({ id: "", recipe: null });
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  const { job } = useStore(topics);
  const running = job && !job.done ? job.job_id : "";
  useEffect(() => {
    if (id === "" || !isLinked) return;
    let isOver = false;
    look("recipe.get", { id }).then(({ recipe }) => {
      if (!isOver) setHeld({ id, recipe });
    }, () => undefined);  // then there are no regions and no z to show; the choice of recipes tells of faults
    return () => {
      isOver = true;
    };
  }, [id, count, running, isLinked]);
  return held.id === id ? held.recipe : null;
}
