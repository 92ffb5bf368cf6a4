// The newest result of a recipe: what its regions are drawn on and its changes are tried with.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { results } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { isObject, type JsonObject } from "../../recipe/schema.ts";
import { call } from "../../rpc/rpc.ts";

export interface Newest {
  job_id: string;
  recipe: string;        // that the job was measured by
  result: JsonObject | null;  // its result.json
  problem: string;
  choose(job_id: string): void;
}

async function find(recipe: string): Promise<string> {
  let before = "";
  do {
    // A part without jobs is not the last one: the daemon looks at so many at a time.
    const { jobs, next } = await call("job.list", { recipe, state: "completed", most: 1, ...(before ? { before } : {}) });
    if (jobs[0]) return jobs[0].job_id;
    before = next;
  } while (before);
  return "";
}

export function useNewestJob(recipe: string): Newest {
  const { count } = useStore(results);
  const [chosen, choose] = useState("");
  const [found, setFound] = useState<Omit<Newest, "choose">>({ job_id: "", recipe: "", result: null, problem: "" });
  useEffect(() => {
    let ended = false;
    const look = async (): Promise<void> => {
      const job_id = chosen || await find(recipe);
      const none = { job_id, recipe: "", result: null, problem: "" };
      if (ended) return;
      if (!job_id) return setFound(none);
      const { result } = await call("result.get", { job_id, format: "complete" });
      const about = isObject(result) ? result : null;
      const job = about?.["job"];
      if (!ended) setFound({ ...none, result: about, recipe: isObject(job) ? String(job["recipe"] ?? "") : "" });
    };
    look().catch((error) => { if (!ended) setFound((was) => ({ ...was, problem: messageOf(error), result: null })); });
    return () => { ended = true; };
  }, [recipe, chosen, count]);
  return { ...found, choose };
}

// Distance of the map's pixels in um; null where the result does not tell.
export function pitchOf(result: JsonObject | null): { x: number; y: number } | null {
  const focus = result?.["focus"];
  if (!isObject(focus)) return null;
  const [x, y] = [focus["pixel_pitch_x_um"], focus["pixel_pitch_y_um"]];
  return typeof x === "number" && typeof y === "number" ? { x, y } : null;
}
