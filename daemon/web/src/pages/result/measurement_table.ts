// Values with U, limits and verdicts; what each rests on, on demand.
import { useState } from "preact/hooks";
import { number, t, tWord } from "../../i18n/i18n.ts";
import { digitsOf } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";
import { shownUnit } from "../../lib/units.ts";
import { type EvaluatedValue, type Measurement, type ResultJson, judgedFigures, measurementsOf } from "../../result/result_json.ts";
import { nameOf } from "../../result/value_text.ts";
import { MeasurementDetails } from "./measurement_details.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";

export function valueText({ value, U }: EvaluatedValue): string {
  return value === undefined ? "–" : number(value, digitsOf(value, U));
}

export const uncertaintyText = ({ value, U }: EvaluatedValue): string =>
  value === undefined || U === undefined ? t("result.no_U") : `± ${number(U, digitsOf(value, U))}`;

export function limitsText({ limits }: EvaluatedValue): string {
  const { lower, upper } = limits ?? {};
  if (lower !== undefined && upper !== undefined) return `${number(lower)} … ${number(upper)}`;
  return lower !== undefined ? `≥ ${number(lower)}` : upper !== undefined ? `≤ ${number(upper)}` : "–";
}

// The main value first, then those that are judged, then the others.
function rowsOf({ values, main_value }: Measurement): [string, EvaluatedValue][] {
  const rank = ([key, value]: [string, EvaluatedValue]): number => (key === main_value ? 0 : value.limits ? 1 : 2);
  return Object.entries(values).sort((a, b) => rank(a) - rank(b));
}

function ValueRow({ name, value }: { name: string; value: EvaluatedValue }) {
  return html`<tr>
    <th scope="row">${name}${shownUnit(value.unit) && ` / ${shownUnit(value.unit)}`}</th>
    <td class="number"><data value=${String(value.value ?? "")}>${valueText(value)}</data></td>
    <td class="number">${uncertaintyText(value)}</td>
    <td class="number">${limitsText(value)}</td>
    <td>${value.verdict ? html`<${VerdictLabel} verdict=${value.verdict}/>` : ""}${value.reason && html`<span class="help">${value.reason}</span>`}
      ${(value.warnings ?? []).map(({ text }) => html`<span class="help">${text}</span>`)}</td>
  </tr>`;
}

// The verdict may come from the map itself, of which too few points are valid.
function MapFigures({ figures }: { figures: [string, EvaluatedValue][] }) {
  return html`<tbody>
    <tr class="measurement-head"><th colspan="5" scope="rowgroup">${t("result.map.title")}</th></tr>
    ${figures.map(([key, value]) => html`<${ValueRow} name=${tWord("run.value", key)} value=${value}/>`)}
  </tbody>`;
}

interface OneProps {
  name: string;
  measurement: Measurement;
  result: ResultJson;
  isShown: boolean;
  all: boolean;  // every value and every detail, for paper
  onShow: (() => void) | null;
}

function OneMeasurement({ name, measurement, result, isShown, all, onShow }: OneProps) {
  const [isOpen, setOpen] = useState(false);
  const rows = rowsOf(measurement);
  const judged = rows.filter(([key, value]) => key === measurement.main_value || value.limits);
  const shown = all || isOpen || judged.length === 0 ? rows : judged;
  return html`<tbody>
    <tr class="measurement-head"><th colspan="4" scope="rowgroup">${name} <span class="help">${tWord("result.kind_of", measurement.kind)}</span>
        ${measurement.reason && html` <span class="problem">${measurement.reason}</span>`}</th>
      <td>${measurement.verdict && html`<${VerdictLabel} verdict=${measurement.verdict}/>`}</td></tr>
    ${shown.map(([key, value]) => html`<${ValueRow} name=${nameOf(key)} value=${value}/>`)}
    ${!all && html`<tr><td colspan="5" class="measurement-buttons">
      <button type="button" aria-expanded=${isOpen} onClick=${() => setOpen(!isOpen)}>${t(isOpen ? "result.less" : "result.more", { name })}</button>
      ${onShow && html`<button type="button" aria-pressed=${isShown} onClick=${onShow}>${t("result.show_geometry", { name })}</button>`}
    </td></tr>`}
    ${(all || isOpen) && html`<tr class="details-row"><td colspan="5"><${MeasurementDetails} measurement=${measurement} result=${result}/></td></tr>`}
  </tbody>`;
}

interface Props {
  result: ResultJson;
  shown: string | null;  // whose geometry is drawn
  all?: boolean;
  onShow: (name: string | null) => void;
}

export function MeasurementTable({ result, shown, all = false, onShow }: Props) {
  const measurements = measurementsOf(result);
  const figures = judgedFigures(result);
  if (measurements.length + figures.length === 0) return html`<p>${t("result.no_measurements")}</p>`;
  return html`<div class="scroll" tabindex="0" role="region" aria-label=${t("result.measurements.table")}><table class="measurements">
    <thead><tr><th scope="col">${t("result.col.value")}</th><th class="number" scope="col">${t("result.col.measured")}</th><th class="number" scope="col">U</th>
      <th class="number" scope="col">${t("result.col.limits")}</th><th scope="col">${t("result.col.verdict")}</th></tr></thead>
    ${measurements.map(([name, measurement]) => html`<${OneMeasurement} key=${name} name=${name} measurement=${measurement} result=${result} all=${all}
      isShown=${shown === name} onShow=${measurement.cross_section ? () => onShow(shown === name ? null : name) : null}/>`)}
    ${figures.length > 0 && html`<${MapFigures} figures=${figures}/>`}
  </table></div>`;
}
