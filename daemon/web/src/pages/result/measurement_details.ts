// Why a value is what it is: uncertainty budgets, the surface it was measured on, what was not taken into account.
import { number, t, tWord } from "../../i18n/i18n.ts";
import { usefulDigits } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";
import { shownUnit } from "../../lib/units.ts";
import { type EvaluatedValue, type Measurement, type Notch, type ResultJson, type SurfaceStep } from "../../result/result_json.ts";
import { nameOf } from "../../result/value_text.ts";

const significant = (value: number | undefined, digits = 3): string =>
  value === undefined ? "–" : number(value, usefulDigits(value, digits));

function Budget({ name, value }: { name: string; value: EvaluatedValue }) {
  const total = (value.budget ?? []).reduce((sum, { u }) => sum + u * u, 0);
  return html`<table class="budget">
    <caption>${t("result.budget.of", { name: nameOf(name) })} u = ${significant(value.u)} ${shownUnit(value.unit)}, k = ${significant(value.k)}${
      value.dof !== undefined && `, ν = ${number(value.dof, 0)}`}${value.u_method && `, ${tWord("result.u_method", value.u_method)}`}</caption>
    <thead><tr><th scope="col">${t("result.budget.source")}</th><th scope="col">${t("result.budget.type")}</th><th class="number" scope="col">u / ${shownUnit(value.unit) || "1"}</th>
      <th class="number" scope="col">${t("result.budget.share")}</th></tr></thead>
    <tbody>${(value.budget ?? []).map(({ source, type, u }) => html`<tr><th scope="row">${tWord("result.source", source)}</th><td>${type}</td>
      <td class="number">${significant(u)}</td><td class="number">${total > 0 ? `${number((100 * u * u) / total, 1)} %` : "–"}</td></tr>`)}</tbody>
  </table>`;
}

function stepText({ op, did, ...settings }: SurfaceStep): string {
  const given = Object.entries(settings).filter(([, value]) => ["string", "number", "boolean"].includes(typeof value) || Array.isArray(value))
    .map(([key, value]) => `${nameOf(key)} ${Array.isArray(value) ? value.join(", ") : typeof value === "number" ? number(value) : String(value)}`);
  const found = Object.entries(did?.values ?? {}).map(([key, { value, standard_error }]) =>
    `${nameOf(key)} = ${significant(value, 4)}${standard_error === undefined ? "" : ` (u ${significant(standard_error, 2)})`}`);
  const points = did?.points_used === undefined ? [] : [t("result.step.points", { used: did.points_used, removed: did.points_removed ?? 0 })];
  return [`${op}${given.length > 0 ? ` (${given.join("; ")})` : ""}`, ...points, ...found].join(" · ");
}

function Notches({ notches }: { notches: Notch[] }) {
  return html`<table><caption>${t("result.notches")}</caption>
    <thead><tr>${["along", "x", "y", "depth", "width"].map((key) => html`<th class="number" scope="col">${tWord("result.notch", key)} / µm</th>`)}<th scope="col">${t("result.notch.note")}</th></tr></thead>
    <tbody>${notches.map((notch) => html`<tr>${[notch.along_um, notch.x_um, notch.y_um, notch.depth_um, notch.width_um].map((value) =>
      html`<td class="number">${number(value, 2)}</td>`)}<td>${notch.open && t("result.notch.open")} ${notch.resolved === false && t("result.notch.unresolved")}</td></tr>`)}</tbody>
  </table>`;
}

export function MeasurementDetails({ measurement, result }: { measurement: Measurement; result: ResultJson }) {
  const { surface, details, values, not_evaluated, warnings, points, valid_fraction, cross_section } = measurement;
  const steps = (surface && result.evaluation?.surfaces?.[surface]) || [];
  const budgets = Object.entries(values).filter(([, { budget }]) => (budget?.length ?? 0) > 0);
  const notches = details?.chipping?.notches ?? [];
  return html`<div class="measurement-details">
    <p>${t("result.surface", { name: surface ?? "measured" })}${measurement.method && ` · ${t("result.method", { name: measurement.method })}`}${
      measurement.region && ` · ${t("result.region", { name: measurement.region })}`} · ${t("result.points", { n: points ?? 0, share: number(100 * (valid_fraction ?? 0), 1) })}</p>
    ${steps.length > 0 && html`<ol class="steps">${steps.map((step) => html`<li>${stepText(step)}</li>`)}</ol>`}
    ${(warnings ?? []).map(({ text }) => html`<p class="problem">${text}</p>`)}
    ${budgets.map(([name, value]) => html`<${Budget} name=${name} value=${value}/>`)}
    ${budgets.length === 0 && html`<p class="help">${t("result.no_budget")}</p>`}
    ${(not_evaluated?.length ?? 0) > 0 && html`<p class="help">${t("result.not_evaluated", { list: (not_evaluated ?? []).map((source) => tWord("result.source", source)).join(", ") })}</p>`}
    ${cross_section && html`<p>${t("result.section", {
      from: `${number(cross_section.from_x_um, 1)}; ${number(cross_section.from_y_um, 1)}`, to: `${number(cross_section.to_x_um, 1)}; ${number(cross_section.to_y_um, 1)}`,
      width: number(cross_section.band_width_um, 1) })}
      ${cross_section.regions.map(({ name, from_um, to_um }) => ` ${name}: ${number(from_um, 1)} … ${number(to_um, 1)} µm.`)}</p>`}
    ${notches.length > 0 && html`<${Notches} notches=${notches}/>`}
  </div>`;
}
