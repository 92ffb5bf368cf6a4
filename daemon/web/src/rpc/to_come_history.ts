// Methods that the daemon does not describe yet, as far as history and editor need them. To be deleted when openrpc.json has them.
import type { Methods } from "./methods.ts";
import { RpcError, call } from "./rpc.ts";

export interface JobRow {
  job_id: string;
  seq: number;
  client: string;
  part_id: string;
  recipe: string;
  state: string;
  verdict: string | null;
  ended_utc: string;
  error: string;
}

export interface JobFilter {
  before?: string;
  most?: number;
  part_id?: string;
  recipe?: string;
  verdict?: string;
  state?: string;
  from_utc?: string;
  to_utc?: string;
}

export interface ValuePoint {
  job_id: string;
  part_id: string;
  ended_utc: string;
  value: number | null;
  u: number | null;
  lower: number | null;
  upper: number | null;
  verdict: string | null;
}

const kNoSuchMethod = -32601;

export const isToCome = (error: unknown): boolean => error instanceof RpcError && error.code === kNoSuchMethod;

type Loose = (method: string, params: object, options?: { signal?: AbortSignal }) => Promise<unknown>;
const anyCall = call as unknown as Loose;

// A status says "ok" where a result says "pass".
const kVerdicts: Record<string, string | null> = { ok: "pass", nok: "fail", undefined: null, "": null };
const verdictOf = (word: string | null | undefined): string | null => (word === null || word === undefined ? null : Object.hasOwn(kVerdicts, word) ? kVerdicts[word] ?? null : word);

export async function jobList(filter: JobFilter, options: { signal?: AbortSignal } = {}): Promise<{ jobs: JobRow[]; next: string }> {
  const { jobs, next } = await anyCall("job.list", filter, options) as { jobs: JobRow[]; next: string };
  return { jobs: jobs.map((row) => ({ ...row, verdict: verdictOf(row.verdict) })), next };
}

export const valueList = (
  params: { measurement: string; value: string; recipe?: string; most: number },
  options: { signal?: AbortSignal } = {},
): Promise<{ points: ValuePoint[] }> => anyCall("value.list", params, options) as Promise<{ points: ValuePoint[] }>;

// The row of one job, of what the daemon tells without a list.
export async function rowOf(which: { seq: number; client: string }): Promise<JobRow> {
  const status: Methods["job.status"]["result"] = await call("job.status", which);
  const { job_id = "", seq = 0, client = "", part_id = "", recipe = "", state = "", ended_utc = "", error = "" } = status;
  return { job_id, seq, client, part_id, recipe, state, verdict: verdictOf(status.evaluation), ended_utc, error };
}
