// STOP of the pages that try recipes: outside of their steps and views, for a motion goes on when its own is left.
import { useState } from "preact/hooks";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { call } from "../../../rpc/rpc.ts";
import { mayTryStop, session } from "../../../rpc/session.ts";
import { stopStage } from "../../../rpc/stop_stage.ts";

// The stage first, whatever has it; then the job, which may be computing without it.
async function stop(): Promise<string> {
  const { job } = topics.get();
  const { stopped } = await stopStage();
  if (stopped !== "job" && job && !job.done) await call("job.abort", { job_id: job.job_id });
  return t(stopped === "nothing" ? "run.stopped_nothing" : "run.stopped");
}

export function StopButton() {
  const { role } = useStore(session);
  const [said, setSaid] = useState("");
  const [problem, setProblem] = useState("");
  // Each press is sent: the one before may be lost.
  const press = (): void => {
    setProblem("");
    stop().then(setSaid, (error: unknown) => setProblem(messageOf(error)));
  };
  return html`<span class="stop-beside">
    <button type="button" class="main stop" disabled=${!mayTryStop(role)} onClick=${press}>${t("setup.stop")}</button>
    <span class="help" aria-live="polite">${said}</span>
    ${problem && html`<span role="alert" class="problem">${problem}</span>`}
  </span>`;
}
