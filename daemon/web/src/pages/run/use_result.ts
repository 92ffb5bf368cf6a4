// The result that the page shows: that of the newest job that ended while it looked on, or before.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { type Full, link, results, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { look } from "../../rpc/look.ts";

export interface ShownResult {
  job_id: string;                                   // empty = nothing was measured yet
  status: Full<"job.status"> | null;                // null = not told yet
  result: unknown;                                  // result.json; null where there is none (yet)
  directory: string;                                // empty = nothing was kept
  isFinal: boolean;                                 // false = it was asked for before the job's end was stored
  problem: string;
}

const kNothing: ShownResult = { job_id: "", status: null, result: null, directory: "", isFinal: false, problem: "" };

// The newest of two jobs: their ids begin with the time.
function useNewestEnded(): string {
  const { job } = useStore(topics);
  const { job_id } = useStore(results);
  const [newest, setNewest] = useState("");
  const ended = job?.done ? job.job_id : "";
  useEffect(() => {
    setNewest((before) => {
      // A result may be told before its job's end is. After a restart with another database the job's word counts.
      if (job_id !== null && job_id > before && job_id >= ended) return job_id;
      return ended || before;
    });
  }, [ended, job_id]);
  return newest;
}

export function useResult(): ShownResult {
  const id = useNewestEnded();
  const isLinked = useStore(link).status === "open";
  const [shown, setShown] = useState<ShownResult>(kNothing);
  const { job } = useStore(topics);
  const told = job?.job_id === id ? job : null;
  const isDone = told?.done === true;
  const has = shown.job_id === id && shown.problem === "" && shown.isFinal;
  useEffect(() => {
    if (id === "" || has || !isLinked) return;
    let isOver = false;
    const fetched = Promise.allSettled([look("job.status", { job_id: id }), look("result.get", { job_id: id, format: "complete" })]);
    void fetched.then(([status, got]) => {
      if (isOver) return;
      const value = got.status === "fulfilled" ? got.value : null;
      const fault = status.status === "rejected" ? status.reason : got.status === "rejected" ? got.reason : null;
      setShown({
        job_id: id,
        status: status.status === "fulfilled" ? (status.value as Full<"job.status">) : null,
        result: value?.result ?? null,
        directory: value?.directory ?? "",
        isFinal: value !== null && value.state !== "processing",
        problem: fault === null ? "" : messageOf(fault),
      });
    });
    return () => {
      isOver = true;
    };
  }, [id, has, isDone, isLinked]);
  // The id alone lets the map be fetched at the same time as the values.
  return shown.job_id === id ? { ...shown, status: told ?? shown.status } : { ...kNothing, job_id: id, status: told };
}
