// Values of two results, old beside new.
import { number, t } from "../../i18n/i18n.ts";
import { digitsOf } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";
import { shownUnit } from "../../lib/units.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";
import { withUnits } from "./fields/names.ts";
import { type Value, pairs } from "../../results/values.ts";

function said(value: Value | null) {
  if (value === null) return html`<span class="help">–</span>`;
  if (value.value === null) return html`<span class="help" lang="en">${withUnits(value.reason) || t("recipe.no_value")}</span>`;
  const digits = digitsOf(value.value, value.U);
  return html`${number(value.value, digits)}${value.U !== null && ` ± ${number(value.U, digits)}`} ${shownUnit(value.unit)}
    ${value.verdict !== null && html`<br/><${VerdictLabel} verdict=${value.verdict}/>`}`;
}

export function ValuePairs({ before, after, heads }: { before: readonly Value[]; after: readonly Value[]; heads: readonly [string, string] }) {
  return html`<div class="scroll"><table>
    <thead><tr><th>${t("recipe.value")}</th><th>${heads[0]}</th><th>${heads[1]}</th><th class="number">${t("recipe.change")}</th></tr></thead>
    <tbody>${pairs(before, after).map((pair) => {
      const [a, b] = [pair.before?.value ?? null, pair.after?.value ?? null];
      return html`<tr>
        <td>${pair.measurement}<br/><span class="help">${pair.name}</span></td><td>${said(pair.before)}</td><td>${said(pair.after)}</td>
        <td class="number">${a !== null && b !== null ? `${b > a ? "+" : ""}${number(b - a, digitsOf(b, pair.after?.U ?? null))}` : "–"}</td>
      </tr>`;
    })}</tbody>
  </table></div>`;
}
