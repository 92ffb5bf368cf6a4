// Tries a draft: kept under an id of its own, then a stored result is evaluated by it, or the part is scanned.
import { RpcError, call } from "../rpc/rpc.ts";
import { sincePress, stopPresses, tooLate } from "../rpc/stop_stage.ts";
import { kClient } from "../run/start_job.ts";
import { tryId } from "./ids.ts";

const kUnknownRecipe = 1005;

// The draft's id once it is kept.
export async function keepForTrial(id: string, text: string, author: string): Promise<string> {
  const trial = tryId(id);
  let base_version = 0;
  try {
    const kept = await call("recipe.get", { id: trial });
    if (kept.text === text) return trial;
    base_version = kept.version;
  } catch (error) {
    if (!(error instanceof RpcError) || error.code !== kUnknownRecipe) throw error;
  }
  await call("recipe.save", { id: trial, text, base_version, author, comment: "to try it" });
  return trial;
}

async function resultOf(job_id: string): Promise<unknown> {
  return (await call("result.get", { job_id, format: "complete" })).result;
}

export async function evaluateBy(job_id: string, recipe: string): Promise<{ id: string; result: unknown }> {
  const { id } = await call("result.evaluate", { job_id, recipe });
  return { id, result: await resultOf(id) };
}

// What a stop after the press is seen by; taken as the button is pressed, before anything is waited for.
export const pressed = () => ({ stops: stopPresses.get(), mayBegin: sincePress() });

// Waits for the scan's end; told() hears how far it is.
export async function scanBy(recipe: string, part_id: string, { stops, mayBegin }: ReturnType<typeof pressed>, told: (progress: number) => void): Promise<{ id: string; result: unknown }> {
  const { newest_seq } = await call("job.latest", { client: kClient });
  if (!mayBegin()) throw tooLate();
  const { job_id } = await call("job.start", { seq: newest_seq + 1, part_id, recipe, client: kClient });
  // On its way it may have been overtaken by a stop, which then found nothing.
  if (stopPresses.get() !== stops) await call("job.abort", { job_id });
  for (;;) {
    const status = await call("job.wait", { job_id, until: "done", timeout_ms: 1000 });
    told(status.progress ?? 0);
    if (!status.done) continue;
    // It is shown to who asked for it, and nobody else will say so; whether that is heard changes nothing here.
    call("result.ack", { job_id }).catch(() => undefined);
    if (status.state !== "completed") throw new Error(`${status.error ?? ""}: ${status.error_message ?? ""}`);
    return { id: job_id, result: await resultOf(job_id) };
  }
}
