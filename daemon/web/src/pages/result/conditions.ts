// Under which conditions the result came about.
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { utcText } from "../../lib/utc_text.ts";
import type { ResultJson } from "../../result/result_json.ts";

export function Conditions({ result }: { result: ResultJson }) {
  const { focus, frames, slices, provenance, evaluation, temperature, objective } = result;
  const unknown = t("result.unknown");
  const rows: [string, string][] = [
    [t("result.cond.recipe"), result.job.recipe],
    [t("result.cond.created"), provenance?.created ? utcText(provenance.created) : unknown],
    [t("result.cond.objective"), objective || unknown],
    [t("result.cond.temperature"), temperature?.celsius === undefined ? unknown : `${number(temperature.celsius, 1)} °C`],
    [t("result.cond.calibration"), tWord("result.calibration", evaluation?.calibration ?? (result.calibration ? "in_force" : "none"))],
    [t("result.cond.rule"), evaluation?.rule ? `${tWord("result.rule", evaluation.rule)}${evaluation.probability === undefined ? "" : `, p = ${number(evaluation.probability)}`}` : "–"],
    [t("result.cond.slices"), slices ? `${slices.measured ?? 0} / ${slices.planned ?? 0}, ${number(slices.first_um ?? NaN, 1)} … ${number(slices.last_um ?? NaN, 1)} µm` : unknown],
    [t("result.cond.frames"), frames ? `${frames.ok ?? 0} / ${frames.expected ?? 0}` : unknown],
    [t("result.cond.pitch"), focus?.pixel_pitch_x_um ? `${number(focus.pixel_pitch_x_um)} × ${number(focus.pixel_pitch_y_um ?? NaN)} µm` : unknown],
    [t("result.cond.focus"), [focus?.operator, focus?.window_px === undefined ? "" : `${focus.window_px} px`, focus?.peak].filter(Boolean).join(", ") || unknown],
    [t("result.cond.exposure"), slices?.exposure_us ? `${number(slices.exposure_us)} µs` : unknown],
    [t("result.cond.software"), `fvd ${provenance?.software_version ?? ""}`],
    [t("result.cond.source"), provenance?.source ?? unknown],
  ];
  return html`<table class="conditions"><tbody>${rows.map(([name, value]) => html`<tr><th scope="row">${name}</th><td>${value}</td></tr>`)}</tbody></table>`;
}
