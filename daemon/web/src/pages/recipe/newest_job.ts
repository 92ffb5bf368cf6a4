// The newest result of a recipe: what its regions are drawn on and its changes are tried with.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { results, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { isObject, type JsonObject } from "../../recipe/schema.ts";
import { call } from "../../rpc/rpc.ts";
import { isToCome, jobList } from "../../rpc/to_come_history.ts";

export interface Newest {
  job_id: string;
  recipe: string;        // that the job was measured by
  result: JsonObject | null;  // its result.json
  problem: string;
  isSearched: boolean;   // whether the daemon could be asked for this recipe's newest job
  choose(job_id: string): void;
}

async function find(recipe: string): Promise<{ job_id: string; isSearched: boolean }> {
  try {
    const { jobs } = await jobList({ recipe, state: "completed", most: 1 });
    return { job_id: jobs[0]?.job_id ?? "", isSearched: true };
  } catch (error) {
    if (!isToCome(error)) throw error;
    const { job } = topics.get();
    const { job_id } = job?.done ? { job_id: job.job_id ?? "" } : await call("job.latest", {});
    return { job_id, isSearched: false };
  }
}

export function useNewestJob(recipe: string): Newest {
  const { count } = useStore(results);
  const [chosen, choose] = useState("");
  const [found, setFound] = useState<Omit<Newest, "choose">>({ job_id: "", recipe: "", result: null, problem: "", isSearched: true });
  useEffect(() => {
    let ended = false;
    const look = async (): Promise<void> => {
      const { job_id, isSearched } = chosen ? { job_id: chosen, isSearched: true } : await find(recipe);
      const none = { job_id, recipe: "", result: null, problem: "", isSearched };
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
