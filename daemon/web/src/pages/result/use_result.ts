// The result of a job, as the daemon has it; asked for again when the job's result became valid.
import { useEffect, useState } from "preact/hooks";
import { useStore } from "../../lib/store.ts";
import { link, results } from "../../live/live.ts";
import type { Methods } from "../../rpc/methods.ts";
import { RpcError, call } from "../../rpc/rpc.ts";
import type { ResultJson } from "../../result/result_json.ts";

export type JobStatus = Methods["job.status"]["result"];

export type Loaded =
  | { kind: "waiting" }
  | { kind: "result"; result: ResultJson; directory: string; ended_utc: string }
  | { kind: "none"; status: JobStatus }  // the job runs, failed or was aborted
  | { kind: "problem"; error: unknown };

async function load(id: string): Promise<Loaded> {
  try {
    const reply = await call("result.get", { job_id: id, format: "complete" });
    if (reply.result) return { kind: "result", result: reply.result as ResultJson, directory: reply.directory ?? "", ended_utc: reply.ended_utc ?? "" };
  } catch (error) {
    // Without a result the job's status may still tell what it came to.
    if (!(error instanceof RpcError) || (error.error !== "unknown_job" && error.error !== "result_removed")) return { kind: "problem", error };
    try {
      return { kind: "none", status: await call("job.status", { job_id: id }) };
    } catch {
      return { kind: "problem", error };
    }
  }
  try {
    return { kind: "none", status: await call("job.status", { job_id: id }) };
  } catch (error) {
    return { kind: "problem", error };
  }
}

export function useResult(id: string): Loaded {
  const [loaded, setLoaded] = useState<Loaded>({ kind: "waiting" });
  const { job_id } = useStore(results);
  const { status } = useStore(link);
  const finished = loaded.kind === "result";
  // What is there never changes; what is not may have come while the connection was lost.
  const again = finished ? "" : `${job_id === id} ${status}`;
  useEffect(() => {
    if (finished) return;
    let ended = false;
    void load(id).then((next) => {
      if (!ended) setLoaded(next);
    });
    return () => void (ended = true);
  }, [id, again]);
  return loaded;
}
