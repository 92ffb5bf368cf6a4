// Values of the trial by the draft's measurements, and the limits of each.
import { useState } from "preact/hooks";
import { number, t } from "../../../i18n/i18n.ts";
import { digitsOf } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { shownUnit } from "../../../lib/units.ts";
import { VerdictLabel } from "../../../parts/verdict_mark.ts";
import { hasMeasurements } from "../../../recipe/kinds.ts";
import { evaluateBy, keepForTrial } from "../../../recipe/try_recipe.ts";
import { session } from "../../../rpc/session.ts";
import { type Value, valuesOf } from "../../../results/values.ts";
import { NumberInput } from "../fields/number_input.ts";
import { withUnits } from "../fields/names.ts";
import type { StepProps } from "./assistant.ts";
import { useRun } from "./run.ts";

export function LimitStep({ editor, newest }: StepProps) {
  const { who } = useStore(session);
  const [measured, setMeasured] = useState<{ values: Value[]; text: string } | null>(null);
  const values = measured?.values ?? null;
  const { why, run, view } = useRun();
  const whyNot = why || (newest.result === null ? t("recipe.no_job")
    : editor.document !== null && !hasMeasurements(editor.document) ? t("recipe.measurement_first") : !editor.check?.accepted || !editor.isChecked ? t("recipe.save_refused") : "");
  const evaluate = async (): Promise<void> => {
    const { text } = editor;
    const trial = await keepForTrial(editor.id, text, who);
    const { result } = await evaluateBy(newest.job_id, trial);
    setMeasured({ values: valuesOf(result).filter((value) => value.measurement !== "map"), text });
  };
  const limit = (value: Value, which: "lower" | "upper") => {
    const path = ["evaluation", "measurements", value.measurement, "limits", value.name, which];
    return html`<${NumberInput} narrow editor=${editor} path=${path} about=${{ "aria-label": t(`recipe.limit_${which}`, { value: `${value.measurement} ${value.name}` }) }}/>`;
  };
  // A verdict by other limits than those beside it is none.
  const isOld = measured !== null && measured.text !== editor.text;
  const again = html`<button type="button" disabled=${whyNot !== ""} onClick=${() => run(t("recipe.trying"), evaluate)}>${t(isOld ? "recipe.judge_again" : "recipe.values_now")}</button>`;
  return html`
    ${!isOld && html`<p class="buttons">${again}</p>`}
    <p class="help">${why === "" ? whyNot : ""}</p>
    ${view}
    ${values && values.length === 0 && html`<p>${t("recipe.no_measurements")}</p>`}
    ${values && values.length > 0 && html`<div class="scroll"><table>
      <thead><tr><th>${t("recipe.value")}</th><th class="number">${t("recipe.measured")}</th><th>${t("history.lower")}</th><th>${t("history.upper")}</th><th>${t("history.verdict")}</th></tr></thead>
      <tbody>${values.map((value) => html`<tr key=${`${value.measurement} ${value.name}`}>
        <td>${value.measurement}<br/><span class="help">${value.name}</span></td>
        <td class="number">${value.value === null ? html`<span class="help" lang="en">${withUnits(value.reason)}</span>`
          : `${number(value.value, digitsOf(value.value, value.U))}${value.U === null ? "" : ` ± ${number(value.U, digitsOf(value.value, value.U))}`} ${shownUnit(value.unit)}`}</td>
        <td>${limit(value, "lower")}</td><td>${limit(value, "upper")}</td>
        <td>${isOld ? html`<span class="help">${t("recipe.verdict_old")}</span>` : html`<${VerdictLabel} verdict=${value.verdict}/>`}</td>
      </tr>`)}</tbody>
    </table></div>`}
    ${isOld && html`<p class="buttons">${again} <span class="help">${t("recipe.tried_before")}</span></p>`}`;
}
