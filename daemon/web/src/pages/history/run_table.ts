// The run chart's points as a table, for who cannot see the curve or wants the job of a point.
import { useState } from "preact/hooks";
import { number, t } from "../../i18n/i18n.ts";
import type { Mark } from "../../history/control_rules.ts";
import { digitsOf } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";
import { utcText } from "../../lib/utc_text.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";
import type { ValuePoint } from "../../rpc/listed.ts";

export function RunTable({ points, marks, unit }: { points: readonly ValuePoint[]; marks: readonly Mark[]; unit: string }) {
  const [open, setOpen] = useState(false);
  const limit = (value: number | null): string => (value === null ? "–" : number(value));
  return html`<details onToggle=${(event: Event) => setOpen((event.target as HTMLDetailsElement).open)}>
    <summary>${t("history.table")}</summary>
    ${open && html`<div class="scroll"><table>
      <thead><tr><th>${t("history.ended")}</th><th>${t("history.part")}</th><th class="number">${t("history.value")} ${unit}</th><th class="number">U</th>
        <th class="number">${t("history.lower")}</th><th class="number">${t("history.upper")}</th><th>${t("history.verdict")}</th><th>${t("history.rules")}</th></tr></thead>
      <tbody>${points.map((point, i) => {
        const digits = point.value === null ? 0 : digitsOf(point.value, point.U);
        return html`<tr key=${point.job_id}>
          <td><a class="row-link" href=${`/jobs/${encodeURIComponent(point.job_id)}`}>${utcText(point.ended_utc)}</a></td><td class="id"><bdi>${point.part_id}</bdi></td>
          <td class="number">${point.value === null ? "–" : number(point.value, digits)}</td>
          <td class="number">${point.U === null ? "–" : number(point.U, digits)}</td>
          <td class="number">${limit(point.lower)}</td><td class="number">${limit(point.upper)}</td>
          <td><${VerdictLabel} verdict=${point.verdict}/></td>
          <td>${[marks[i]?.rule1 ? "◇ 1" : "", marks[i]?.rule4 ? "△ 4" : ""].filter(Boolean).join(", ")}</td>
        </tr>`;
      })}</tbody>
    </table></div>`}
  </details>`;
}
