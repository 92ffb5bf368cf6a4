// What the daemon's description does not name yet. Once openrpc.json has these methods, call() takes their place and this file goes.
import { RpcError, call } from "../../rpc/rpc.ts";
import type { JobRow } from "../../rpc/to_come_history.ts";

export type ListedJob = JobRow;

type AnyCall = (method: string, params: Record<string, unknown>) => Promise<unknown>;
const anyCall = call as unknown as AnyCall;

const kMethodNotFound = -32601;

export const isNotOffered = (error: unknown): boolean => error instanceof RpcError && error.code === kMethodNotFound;

export async function listJobs(filter: { part_id?: string; recipe?: string; state?: string; most?: number }): Promise<ListedJob[]> {
  const reply = (await anyCall("job.list", filter)) as { jobs: ListedJob[] };
  return reply.jobs;
}

export async function acknowledgeAlarm(number: number): Promise<void> {
  await anyCall("alarm.acknowledge", { number });
}

// A study by its name, for its parameters are filled into a form made of the daemon's description.
export async function runStudy(method: string, params: Record<string, unknown>): Promise<StudyReply> {
  return (await anyCall(method, params)) as StudyReply;
}

export interface Figure {
  name: string;
  value: number | null;
  unit: string;
  u?: number;
  U?: number;
  k?: number;
  reason: string;
}

export interface Study {
  id: string;
  kind: string;
  time: string;
  person: string;
  objective: string;
  simulated: boolean;
  jobs: string[];
  figures: Figure[];
  warnings: { code: string; text: string }[];
  refusals: unknown[];
  files: string[];
  proposal?: Record<string, unknown>;
}

export interface StudyReply {
  study: Study;
  directory: string;
  report: string;
}

export interface ListedStudy {
  id: string;
  kind: string;
  time: string;
  person: string;
  objective: string;
  recipe: string;
  jobs: number;
  simulated: boolean;
  warnings: number;
  calibration?: string | null;
}
