// Methods that openrpc.json does not describe yet. Once it does, call look() and call() with their own types.
import type { Methods } from "../../rpc/methods.ts";
import { look } from "../../rpc/look.ts";
import { call } from "../../rpc/rpc.ts";
import type { JobRow } from "../../rpc/to_come_history.ts";

export type ListedJob = JobRow;

export const listJobs = (most: number): Promise<{ jobs: ListedJob[]; next: string }> =>
  look("job.list" as keyof Methods, { most } as never) as unknown as Promise<{ jobs: ListedJob[]; next: string }>;

export const acknowledgeAlarm = (number: number): Promise<unknown> =>
  call("alarm.acknowledge" as keyof Methods, { number } as never) as Promise<unknown>;
