// Jobs in rows: to open, to choose two for a comparison, to take along as CSV.
import { t, tWord } from "../../i18n/i18n.ts";
import { csvOf } from "../../history/csv.ts";
import { download } from "../../lib/download.ts";
import { html } from "../../lib/html.ts";
import { utcText } from "../../lib/utc_text.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";
import type { JobRow } from "../../rpc/listed.ts";

const kColumns = ["job_id", "seq", "client", "part_id", "recipe", "state", "verdict", "ended_utc", "error"] as const;

export function JobTable({ rows, chosen, onChoose }: { rows: readonly JobRow[]; chosen: readonly string[]; onChoose: (job_id: string) => void }) {
  const [a, b] = chosen;
  return html`<div class="scroll"><table class="jobs">
      <thead><tr><th>${t("history.compare_short")}</th><th>${t("history.ended")}</th><th>${t("history.part")}</th><th>${t("history.recipe")}</th>
        <th>${t("history.verdict")}</th><th>${t("history.state")}</th><th>${t("history.job")}</th></tr></thead>
      <tbody>${rows.map((row) => html`<tr key=${row.job_id}>
        <td><input type="checkbox" checked=${chosen.includes(row.job_id)} aria-label=${t("history.choose", { job: row.job_id })} onChange=${() => onChoose(row.job_id)}/></td>
        <td class="time">${utcText(row.ended_utc)}</td>
        <td class="id"><a class="row-link" href=${`/jobs/${encodeURIComponent(row.job_id)}`}><bdi>${row.part_id}</bdi></a></td>
        <td class="id"><a href=${`/recipes/${encodeURIComponent(row.recipe)}`}>${row.recipe}</a></td>
        <td><${VerdictLabel} verdict=${row.verdict}/></td>
        <td>${tWord("history.state", row.state)}${row.error && html`<br/><span class="help">${row.error}</span>`}</td>
        <td class="id"><a class="row-link" href=${`/jobs/${encodeURIComponent(row.job_id)}`}>${row.job_id}</a></td>
      </tr>`)}</tbody>
    </table></div>
    <p class="buttons">
      ${a && b
        ? html`<a class="button" href=${`/jobs?compare=${encodeURIComponent(a)},${encodeURIComponent(b)}`}>${t("history.compare")}</a>`
        : html`<button type="button" disabled>${t("history.compare_two")}</button>`}
      <button type="button" disabled=${rows.length === 0} onClick=${() => download("jobs.csv", "text/csv", csvOf(kColumns, rows.map((row) => kColumns.map((name) => row[name]))))}>${t("history.csv")}</button>
    </p>`;
}
