// Jobs from the newest on, page by page; of a daemon without a list, what its sequence numbers tell.
import { RpcError, call } from "../rpc/rpc.ts";
import { type JobFilter, type JobRow, isToCome, jobList, rowOf, valueList, type ValuePoint } from "../rpc/to_come_history.ts";
import { valuesOf } from "../results/values.ts";

export interface Page {
  jobs: JobRow[];
  next: string;       // "" = there are no more
  isListed: boolean;  // false: these are the newest jobs by their numbers, unfiltered
}

const kClients = ["plc", "page"];
const kNewest = 20;

async function newestOf(client: string): Promise<JobRow[]> {
  const { newest_seq } = await call("job.latest", { client });
  const rows: JobRow[] = [];
  for (let seq = newest_seq; seq > 0 && seq > newest_seq - kNewest; --seq) {
    try {
      rows.push(await rowOf({ seq, client }));
    } catch (error) {
      // A client may leave numbers out.
      if (!(error instanceof RpcError) || error.code < 1000) throw error;
    }
  }
  return rows;
}

export async function jobPage(filter: JobFilter, options: { signal?: AbortSignal } = {}): Promise<Page> {
  try {
    return { ...(await jobList(filter, options)), isListed: true };
  } catch (error) {
    if (!isToCome(error)) throw error;
  }
  const rows = (await Promise.all(kClients.map((client) => newestOf(client).catch(() => [])))).flat();
  // Ids begin with the time of the start, which a job has that has not ended.
  return { jobs: rows.sort((a, b) => (a.job_id < b.job_id ? 1 : -1)), next: "", isListed: false };
}

// Oldest first.
export async function valuePoints(
  params: { measurement: string; value: string; recipe?: string; most: number },
  rows: readonly JobRow[],
): Promise<{ points: ValuePoint[]; isListed: boolean }> {
  try {
    const { points } = await valueList(params);
    return { points: [...points].sort((a, b) => (a.ended_utc < b.ended_utc ? -1 : a.ended_utc > b.ended_utc ? 1 : 0)), isListed: true };
  } catch (error) {
    if (!isToCome(error)) throw error;
  }
  const newest = rows.filter((row) => row.state === "completed" && (!params.recipe || row.recipe === params.recipe)).slice(0, kNewest);
  const points = await Promise.all(newest.map(async (row): Promise<ValuePoint | null> => {
    const { result } = await call("result.get", { job_id: row.job_id, format: "complete" });
    const found = valuesOf(result).find((each) => each.measurement === params.measurement && each.name === params.value);
    return found ? {
      job_id: row.job_id, part_id: row.part_id, ended_utc: row.ended_utc,
      value: found.value, u: found.U, lower: found.lower, upper: found.upper, verdict: found.verdict,
    } : null;
  }));
  return { points: points.filter((point): point is ValuePoint => point !== null).reverse(), isListed: false };
}
