// The files of a result as they are now. Those that no verdict waited for are made after it, and no event tells when.
import { useEffect, useState } from "preact/hooks";
import { pause } from "../../lib/patience.ts";
import type { ResultFile, ResultJson } from "../../result/result_json.ts";
import { RpcError, call } from "../../rpc/rpc.ts";

const kFirst_ms = 1000;
const kLongest_ms = 30000;  // a disk that is full keeps a file waiting for days

// No later answer would be another one.
const kGone: ReadonlySet<string> = new Set(["result_removed", "unknown_job"]);

const isWaiting = (files: readonly ResultFile[]): boolean => files.some(({ state }) => state === "pending");

async function follow(job_id: string, signal: AbortSignal, tell: (files: readonly ResultFile[]) => void): Promise<void> {
  for (let wait_ms = kFirst_ms; ; wait_ms = Math.min(kLongest_ms, 2 * wait_ms)) {
    await pause(wait_ms, signal);
    if (signal.aborted) return;
    try {
      const { result } = await call("result.get", { job_id, format: "complete" }, { signal });
      if (signal.aborted || !result) return;  // what was shown stays
      const files = (result as ResultJson).files ?? [];
      tell(files);
      if (!isWaiting(files)) return;
    } catch (error) {
      if (error instanceof RpcError && kGone.has(error.error)) return;
      // Whether fvd answers is told on top of every page; the next look may see more.
    }
  }
}

export function useFiles(result: ResultJson): readonly ResultFile[] {
  const [files, setFiles] = useState<readonly ResultFile[]>(result.files ?? []);
  const { job_id } = result.job;
  useEffect(() => {
    const known = result.files ?? [];
    setFiles(known);
    if (!isWaiting(known)) return;
    const ending = new AbortController();
    void follow(job_id, ending.signal, setFiles);
    return () => ending.abort();
  }, [result]);
  return files;
}
