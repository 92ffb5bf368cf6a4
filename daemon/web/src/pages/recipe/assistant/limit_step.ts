// Values of the trial by the draft's measurements, and the limits of each.
import { useState } from "preact/hooks";
import { number, t } from "../../../i18n/i18n.ts";
import { digitsOf } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { shownUnit } from "../../../lib/units.ts";
import { VerdictLabel } from "../../../parts/verdict_mark.ts";
import { evaluateBy, keepForTrial } from "../../../recipe/try_recipe.ts";
import { session } from "../../../rpc/session.ts";
import { type Value, valuesOf } from "../../../results/values.ts";
import { NumberInput } from "../fields/number_input.ts";
import { withUnits } from "../fields/names.ts";
import type { StepProps } from "./assistant.ts";
import { useRun } from "./run.ts";

export function LimitStep({ editor, newest }: StepProps) {
  const { who } = useStore(session);
  const [values, setValues] = useState<Value[] | null>(null);
  const { why, run, view } = useRun();
  const whyNot = why || (newest.result === null ? t("recipe.no_job") : !editor.check?.accepted || !editor.isChecked ? t("recipe.save_refused") : "");
  const evaluate = async (): Promise<void> => {
    const trial = await keepForTrial(editor.id, editor.text, who);
    const { result } = await evaluateBy(newest.job_id, trial);
    setValues(valuesOf(result).filter((value) => value.measurement !== "map"));
  };
  const limit = (value: Value, which: "lower" | "upper") => {
    const path = ["evaluation", "measurements", value.measurement, "limits", value.name, which];
    return html`<${NumberInput} narrow editor=${editor} path=${path} about=${{ "aria-label": t(`recipe.limit_${which}`, { value: `${value.measurement} ${value.name}` }) }}/>`;
  };
  return html`
    <p class="buttons"><button type="button" disabled=${whyNot !== ""} onClick=${() => run(t("recipe.trying"), evaluate)}>${t("recipe.values_now")}</button></p>
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
        <td><${VerdictLabel} verdict=${value.verdict}/></td>
      </tr>`)}</tbody>
    </table></div>`}`;
}
