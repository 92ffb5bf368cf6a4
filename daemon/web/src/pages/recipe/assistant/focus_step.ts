// The range of z that is sharp, and from it range and step of the scan, with the reasons.
import { useState } from "preact/hooks";
import { asCommand } from "../../../camera/devices_turn.ts";
import { number, t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { readNumber } from "../../../lib/read_number.ts";
import { getAt } from "../../../recipe/document.ts";
import { recipeSchema } from "../../../recipe/schema.ts";
import { type CurvePoint, type FocusCurve, type Scan, readCurve, suggestScan } from "../../../recipe/suggest.ts";
import { call } from "../../../rpc/rpc.ts";
import { Field } from "../fields/field.ts";
import type { StepProps } from "./assistant.ts";
import { FocusCurvePicture } from "./focus_curve_picture.ts";
import { Reference, isReferenceMissing } from "./reference.ts";
import { useRun } from "./run.ts";

export function FocusStep({ editor }: StepProps) {
  const [from, setFrom] = useState("0");
  const [to, setTo] = useState("200");
  const [found, setFound] = useState<{ points: CurvePoint[]; curve: FocusCurve | null; scan: Scan | null } | null>(null);
  const [hasReference, setHasReference] = useState(false);
  const seeking = useRun();
  const { why, run, view } = seeking;
  const isMissing = isReferenceMissing(seeking.error);
  const [low, high] = [readNumber(from), readNumber(to)];
  const whyNot = why || (low === null || high === null || low >= high ? t("recipe.range_wrong") : "");
  const exposure = getAt(editor.document ?? undefined, ["acquire", "camera", "exposure_us"]);

  const seek = async (): Promise<void> => {
    if (low === null || high === null) return;
    const answer = await asCommand(() => call("stage.autofocus", { from_um: low, to_um: high, ...(typeof exposure === "number" ? { exposure_us: exposure } : {}) }));
    const points = answer.curve_um_focus as CurvePoint[];
    const curve = readCurve(points);
    const scan = curve && suggestScan(curve);
    setFound({ points, curve, scan });
    if (scan) for (const [key, value] of Object.entries(scan)) editor.set(["acquire", "scan", key], value);
  };
  const parts = recipeSchema.properties ?? {};
  const scan = parts["acquire"]?.properties?.["scan"]?.properties ?? {};
  const lateral = parts["reconstruct"]?.properties?.["lateral"]?.properties ?? {};
  const focus = parts["reconstruct"]?.properties?.["focus"]?.properties ?? {};
  const field = (schemas: typeof scan, path: readonly string[]) =>
    html`<${Field} editor=${editor} schema=${schemas[path[path.length - 1] ?? ""] ?? {}} path=${path} required=${false}/>`;
  return html`
    <div class="add">
      <label>${t("recipe.seek_from")} <input class="number" inputmode="decimal" value=${from} onInput=${(event: Event) => setFrom((event.target as HTMLInputElement).value)}/></label>
      <label>${t("recipe.seek_to")} <input class="number" inputmode="decimal" value=${to} onInput=${(event: Event) => setTo((event.target as HTMLInputElement).value)}/></label>
      <button type="button" disabled=${whyNot !== ""} onClick=${() => {
        setHasReference(false);
        run(t("recipe.seeking_focus"), seek);
      }}>${t("recipe.seek_focus")}</button>
    </div>
    <p class="help">${t("recipe.moves_stage")} ${why === "" ? whyNot : ""}</p>
    ${isMissing ? html`<${Reference} seek=${seeking} onFound=${() => setHasReference(true)}/>` : view}
    ${hasReference && html`<p aria-live="polite">${t("run.homed")} ${t("recipe.seek_now")}</p>`}
    ${found && html`<${FocusCurvePicture} points=${found.points} scan=${found.scan}/>`}
    ${found && !found.curve && html`<p class="problem">${t("recipe.no_peak")}</p>`}
    ${found?.curve && found.scan && html`<ul>
      <li>${t("recipe.reason_range", {
        from: number(found.scan.start_um), to: number(found.scan.start_um + found.scan.step_um * (found.scan.slices - 1)),
        first: number(found.curve.first_um, 1), last: number(found.curve.last_um, 1), width: number(found.curve.width_um, 1),
      })}</li>
      <li>${t("recipe.reason_step", { step: number(found.scan.step_um), width: number(found.curve.width_um, 1) })}</li>
      <li>${t("recipe.reason_window")}</li>
    </ul>`}
    <div class="members">
      ${["start_um", "step_um", "slices"].map((key) => field(scan, ["acquire", "scan", key]))}
      ${field(focus, ["reconstruct", "focus", "window_px"])}
      ${["pixel_pitch_x_um", "pixel_pitch_y_um"].map((key) => field(lateral, ["reconstruct", "lateral", key]))}
    </div>`;
}
