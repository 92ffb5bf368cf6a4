// What the one button and the keys do.
import { t } from "../../i18n/i18n.ts";
import { leavings } from "../../lib/visit.ts";
import { topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { look } from "../../rpc/look.ts";
import { call } from "../../rpc/rpc.ts";
import { mayTryStop, session } from "../../rpc/session.ts";
import { asMotion, stopPresses, stopStage } from "../../rpc/stop_stage.ts";
import type { ButtonAction } from "../../run/button_rules.ts";
import { nextPartId } from "../../run/part_ids.ts";
import { createStarter, kClient, newSession } from "../../run/start_job.ts";
import { awaited, countsOn, lacksReference, notice, partId } from "./run_state.ts";

const starter = createStarter({
  start: (params, signal) => call("job.start", params, { signal }),
  newest: async () => (await look("job.latest", { client: kClient })).newest_seq,
  wait: (duration_ms) => new Promise((resolve) => setTimeout(resolve, duration_ms)),
}, newSession());
stopPresses.watch(starter.cancel);  // wherever it was pressed
leavings.watch(starter.cancel);  // who comes back has not pressed anything yet

// Asks for the newest number ahead of the press that needs it.
export function askNewest(): void {
  starter.forget();
  look("job.latest", { client: kClient }).then(({ newest_seq }) => starter.know(newest_seq), () => undefined);
}

const problem = (error: unknown): void => notice.set({ kind: "problem", text: messageOf(error) });

async function during(action: ButtonAction | "home", work: () => Promise<void>): Promise<void> {
  // Each stop is sent: the one before may be lost.
  if (awaited.get() === action && action !== "stop") return;
  awaited.set(action);
  notice.set(null);
  try {
    await work();
  } catch (error) {
    problem(error);
  } finally {
    if (awaited.get() === action) awaited.set(null);
  }
}

export const start = (part_id: string, recipe: string): Promise<void> => during("start", async () => {
  const before = stopPresses.get();
  const started = await starter.start(part_id, recipe);
  // On its way it may have been overtaken by a stop, which then found nothing.
  if (stopPresses.get() !== before) await call("job.abort", { job_id: started.job_id });
  if (started.duplicate) notice.set({ kind: "note", text: t("run.duplicate", { seq: started.seq }) });
  if (partId.get() === part_id) partId.set(countsOn.get() ? nextPartId(part_id) : "");
});

// The stage first, whatever has it; then the job, which may be computing without it.
export const stop = (): Promise<void> => during("stop", async () => {
  if (!mayTryStop(session.get().role)) {
    notice.set({ kind: "problem", text: t("run.why.no_role") });
    return;
  }
  const { job } = topics.get();
  const { stopped } = await stopStage();
  if (stopped !== "job" && job && !job.done) await call("job.abort", { job_id: job.job_id });
  notice.set({ kind: "note", text: t(stopped === "nothing" ? "run.stopped_nothing" : "run.stopped") });
});

export const reset = (): Promise<void> => during("reset", async () => {
  const { homed } = await call("error.reset", {});
  lacksReference.set(!homed);
  notice.set({ kind: "note", text: t(homed ? "run.reset_done" : "run.reset_not_homed") });
});

export const home = (): Promise<void> => during("home", async () => {
  await asMotion(() => call("stage.home", {}));
  lacksReference.set(false);
  notice.set({ kind: "note", text: t("run.homed") });
});
