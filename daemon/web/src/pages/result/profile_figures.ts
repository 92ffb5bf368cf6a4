// What two cursors tell of a profile, and the line or circle fitted between them.
import { number, t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { type CircleFit, type LineFit, between, nearest } from "../../surface/profile_fits.ts";
import type { Profile } from "../../surface/profile_line.ts";
import { NumberField } from "./number_field.ts";
import type { Cursors } from "./profile_plot.ts";

export type FitKind = "none" | "line" | "circle";

interface Props {
  profile: Profile;
  unit: string;
  cursors: Cursors;
  kind: FitKind;
  fit: LineFit | CircleFit | null;
  onCursors: (cursors: Cursors) => void;
  onKind: (kind: FitKind) => void;
}

const figure = (name: string, value: string, unit = "") => html`<div><dt>${name}</dt><dd>${value}${unit && ` ${unit}`}</dd></div>`;

function FitFigures({ fit, unit }: { fit: LineFit | CircleFit; unit: string }) {
  if (fit.kind === "line") {
    return html`<dl class="readout">
      ${figure(t("result.fit.angle"), number(fit.angle_deg, 3), "°")}
      ${figure(t("result.fit.at_zero"), number(fit.at_zero, 3), "µm")}
      ${figure(t("result.fit.rms"), number(fit.rms, 4), "µm")}
      ${figure(t("result.fit.points"), number(fit.points))}</dl>`;
  }
  return html`<dl class="readout">
    ${figure(t("result.fit.radius"), number(fit.radius, 3), "µm")}
    ${figure(t("result.fit.centre"), `${number(fit.x, 2)} ${unit} / ${number(fit.y, 2)} µm`)}
    ${figure(t("result.fit.form"), t(fit.convex ? "result.fit.convex" : "result.fit.concave"))}
    ${figure(t("result.fit.rms"), number(fit.rms, 4), "µm")}
    ${figure(t("result.fit.points"), number(fit.points))}</dl>`;
}

export function ProfileFigures({ profile, unit, cursors, kind, fit, onCursors, onKind }: Props) {
  const { distance_um, height_um } = profile;
  const length = (distance_um.at(-1) ?? 0) + (distance_um[0] ?? 0);
  const [a, b] = [cursors.first, cursors.second].map((at) => nearest(distance_um, height_um, at)) as [ReturnType<typeof nearest>, ReturnType<typeof nearest>];
  const told = a && b && a.z !== null && b.z !== null ? between({ x: a.x, z: a.z }, { x: b.x, z: b.z }) : null;
  const z = (at: typeof a): string => (at === null || at.z === null ? t("result.hole") : number(at.z, 3));
  return html`<div>
    <div class="controls">
      <${NumberField} label=${t("result.cursor.first")} unit=${unit} value=${cursors.first} digits=${2} least=${0} most=${length}
        onChange=${(first: number) => onCursors({ ...cursors, first })}/>
      <${NumberField} label=${t("result.cursor.second")} unit=${unit} value=${cursors.second} digits=${2} least=${0} most=${length}
        onChange=${(second: number) => onCursors({ ...cursors, second })}/>
      <label>${t("result.fit.title")}
        <select value=${kind} onChange=${(event: Event) => onKind((event.target as HTMLSelectElement).value as FitKind)}>
          <option value="none">${t("result.fit.none")}</option>
          <option value="line">${t("result.fit.line")}</option>
          <option value="circle">${t("result.fit.circle")}</option>
        </select></label>
    </div>
    <dl class="readout" aria-live="polite">
      ${figure("z 1", z(a), typeof a?.z === "number" ? "µm" : "")}
      ${figure("z 2", z(b), typeof b?.z === "number" ? "µm" : "")}
      ${figure("dx", told ? number(told.dx, 3) : "–", unit)}
      ${figure("dz", told ? number(told.dz, 3) : "–", "µm")}
      ${figure(t("result.cursor.angle"), told ? number(told.angle_deg, 3) : "–", "°")}
      ${figure(t("result.cursor.length"), told ? number(told.length, 3) : "–", "µm")}
    </dl>
    ${unit !== "µm" && html`<p class="help">${t("result.no_pitch")}</p>`}
    ${kind !== "none" && (fit ? html`<${FitFigures} fit=${fit} unit=${unit}/>` : html`<p role="status">${t("result.fit.impossible")}</p>`)}
  </div>`;
}
