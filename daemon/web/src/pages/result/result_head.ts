// Which part, which verdict, when; and what lowers trust in it.
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { utcText } from "../../lib/utc_text.ts";
import type { ResultJson } from "../../result/result_json.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";

export function ResultHead({ result, ended_utc }: { result: ResultJson; ended_utc: string }) {
  const { job, source, provenance, warnings } = result;
  return html`<header class="result-head">
    <h1><bdi>${job.part_id || t("result.no_part")}</bdi></h1>
    <${VerdictLabel} verdict=${result.verdict} size=${32}/>
    ${provenance?.simulated && html`<p class="result-simulated">${t("result.simulated")}</p>`}
    <p>${t("result.head", { job: job.job_id, recipe: job.recipe, time: utcText(ended_utc || provenance?.created || "") })}</p>
    ${source && html`<p>${t("result.evaluated", { time: utcText(result.evaluated ?? ""), recipe: source.recipe?.id ?? "" })}
      ${" "}<a href=${`/jobs/${encodeURIComponent(source.job_id)}`}>${source.job_id}</a></p>`}
    ${(warnings?.length ?? 0) > 0 && html`<ul class="warnings">${(warnings ?? []).map(({ text }) => html`<li>${text}</li>`)}</ul>`}
  </header>`;
}
