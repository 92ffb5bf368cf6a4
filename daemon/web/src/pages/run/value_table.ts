// What was measured: name, value, U, limits, verdict.
import { number, t, tWord } from "../../i18n/i18n.ts";
import { digitsOf } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";
import { shownUnit } from "../../lib/units.ts";
import { VerdictLabel, verdictWord } from "../../parts/verdict_mark.ts";
import { nameOf } from "../../result/value_text.ts";
import { type ValueRow, forPeople } from "../../run/value_rows.ts";
import { LimitBarView, limitsText } from "./limit_bar_view.ts";

function Row({ row: raw }: { row: ValueRow }) {
  const row = forPeople(raw);
  const unit = shownUnit(row.unit);
  const digits = row.value === null ? 2 : digitsOf(row.value, row.U);
  const withUnit = (value: number): string => `${number(value, digits)}${unit && ` ${unit}`}`;
  const limits = limitsText(row, unit);
  const value = row.value === null ? t("run.no_value") : withUnit(row.value);
  return html`<tr>
    <th scope="row">${row.measurement ? html`<span class="measurement">${row.measurement}</span> ${nameOf(row.name)}` : tWord("run.value", row.name)}</th>
    <td class="number">${value}</td>
    <td class="number">${row.value === null ? "" : row.U === null ? html`<span class="help">${t("run.no_u")}</span>` : `± ${withUnit(row.U)}`}</td>
    <td class="limits">${row.value !== null && html`<${LimitBarView} row=${row} label=${`${value}; ${limits}; ${verdictWord(row.verdict)}`}/>`}
      ${row.reason && html`<p class="reason">${row.reason}</p>`}<span class="help">${limits}</span></td>
    <td>${row.verdict === null ? html`<span class="help">${t("run.not_judged")}</span>` : html`<${VerdictLabel} verdict=${row.verdict}/>`}</td>
  </tr>`;
}

export function ValueTable({ rows }: { rows: readonly ValueRow[] }) {
  if (rows.length === 0) return html`<p class="help">${t("run.no_values")}</p>`;
  return html`<div class="scroll" tabindex="0" role="group" aria-label=${t("run.values")}>
    <table class="values">
      <caption class="hidden">${t("run.values")}</caption>
      <thead><tr>
        <th scope="col">${t("run.column_name")}</th>
        <th scope="col" class="number">${t("run.column_value")}</th>
        <th scope="col" class="number">${t("run.column_u")}</th>
        <th scope="col">${t("run.column_limits")}</th>
        <th scope="col">${t("run.column_verdict")}</th>
      </tr></thead>
      <tbody>${rows.map((row) => html`<${Row} key=${`${row.measurement}.${row.name}`} row=${row}/>`)}</tbody>
    </table>
  </div>`;
}
