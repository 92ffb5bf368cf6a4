// What the newest scan gave: map, verdict, values; or why there is nothing.
import { useEffect, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { HeightMap, type Pitch } from "../../parts/height_map.ts";
import { messageOf } from "../../parts/message_of.ts";
import { VerdictLabel, verdictWord } from "../../parts/verdict_mark.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { kClient } from "../../run/start_job.ts";
import { mainHoleReason, rowsOf, verdictOf } from "../../run/value_rows.ts";
import type { ShownResult } from "./use_result.ts";
import { ValueTable } from "./value_table.ts";
import { whatToDo } from "./what_to_do.ts";

// A job that was started here is acknowledged once it was shown: nobody else does it, and results would pile up.
function useAcknowledgement({ status }: ShownResult): string {
  const { role } = useStore(session);
  const [problem, setProblem] = useState("");
  const job_id = status?.done && status.client === kClient && !status.acknowledged && mayAs(role, "operate") ? status.job_id : "";
  useEffect(() => {
    setProblem("");
    if (job_id !== "") call("result.ack", { job_id }).catch((error: unknown) => setProblem(messageOf(error)));
  }, [job_id]);
  return problem;
}

function pitchOfResult(result: unknown): Pitch | null {
  const focus = (result as { focus?: { pixel_pitch_x_um?: unknown; pixel_pitch_y_um?: unknown } } | null)?.focus;
  const { pixel_pitch_x_um: x, pixel_pitch_y_um: y } = focus ?? {};
  return typeof x === "number" && typeof y === "number" && x > 0 && y > 0 ? { x, y } : null;
}

// Why a job has no result, what to do, and what is left of it.
function Failure({ shown: { status, directory } }: { shown: ShownResult }) {
  const { state } = useStore(topics);
  if (!status) return null;
  const isAborted = status.state === "aborted";
  return html`<div role="alert" class="failure">
    <p class="problem">${t(isAborted ? "run.job_aborted" : "run.job_failed")} <strong>${status.error_message}</strong> <span class="code">${status.error_code} ${status.error}</span></p>
    <p>${whatToDo(status.error_code)}</p>
    <p class="help">${t("run.job_got", { done: status.slices_done, planned: status.slices_planned, ok: status.frames_ok, expected: status.frames_expected })} ${" "}
      ${directory ? t("run.job_kept", { directory }) : t("run.job_kept_nothing")}</p>
    ${!status.acquired && !state?.part_release && html`<p>${t("run.job_not_acquired")}</p>`}
  </div>`;
}

function Title({ id, text, shown }: { id: string; text: string; shown: ShownResult }) {
  const { job } = useStore(topics);
  const isPrevious = job !== null && !job.done && shown.status !== null;
  return html`<h2 id=${id}>${text} ${shown.status && html`<bdi class="part-id">${shown.status.part_id}</bdi>`}
    ${isPrevious && html` <span class="tag">${t(shown.status?.part_id === job.part_id ? "run.previous_scan" : "run.previous_part")}</span>`}</h2>`;
}

export function MapPanel({ shown }: { shown: ShownResult }) {
  useLanguage();
  const { job_id, status, result } = shown;
  const reason = mainHoleReason(result);
  return html`<section class="panel map" aria-labelledby="map-title">
    <${Title} id="map-title" text=${t("run.map")} shown=${shown}/>
    ${job_id === "" || status?.state !== "completed"
      ? html`<p class="picture picture-says">${t(job_id === "" ? "run.nothing_measured" : "run.no_map")}</p>`
      : html`<${HeightMap} jobId=${job_id} pitch=${pitchOfResult(result)} verdict=${verdictWord(verdictOf(status.evaluation))}
          noPointReason=${reason && t("run.most_holes", { reason: tWord("run.hole", reason) })}/>
        <p><a href=${`/jobs/${encodeURIComponent(job_id)}`}>${t("run.to_result")}</a></p>`}
  </section>`;
}

function warningsOf(result: unknown): string[] {
  const { warnings } = (result ?? {}) as { warnings?: unknown };
  return Array.isArray(warnings) ? warnings.map((each) => String((each as { text?: unknown }).text ?? each)) : [];
}

export function ValuesPanel({ shown }: { shown: ShownResult }) {
  useLanguage();
  const notAcknowledged = useAcknowledgement(shown);
  const { status, result, problem } = shown;
  const warnings = warningsOf(result);
  return html`<section class="panel results" aria-labelledby="values-title">
    <${Title} id="values-title" text=${t("run.values_of")} shown=${shown}/>
    ${shown.job_id === "" && html`<p class="help">${t("run.nothing_measured")}</p>`}
    ${status?.state === "completed" && html`<p class="big-verdict"><${VerdictLabel} verdict=${verdictOf(status.evaluation)} size=${32}/></p>`}
    ${(status?.state === "failed" || status?.state === "aborted") && html`<${Failure} shown=${shown}/>`}
    ${status?.warning && html`<p class="problem" role="alert">${status.warning}</p>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    ${notAcknowledged && html`<p class="problem" role="alert">${t("run.not_acknowledged", { problem: notAcknowledged })}</p>`}
    ${status?.state === "completed" && result !== null && html`<${ValueTable} rows=${rowsOf(result)}/>`}
    ${warnings.length > 0 && html`<h3>${t("run.warnings")}</h3><ul>${warnings.map((text) => html`<li>${text}</li>`)}</ul>`}
  </section>`;
}
