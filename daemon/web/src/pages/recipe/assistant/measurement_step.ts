// What is measured: chosen from a list, then made to fit.
import { useMemo } from "preact/hooks";
import { t, type TextKey } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { hasMeasurements, kMeasurements, newMeasurement, regionsMissing } from "../../../recipe/kinds.ts";
import { kUnknownHeights, stepHeights } from "../../../recipe/region_heights.ts";
import { isObject, recipeSchema } from "../../../recipe/schema.ts";
import { Field } from "../fields/field.ts";
import { pitchOf } from "../newest_job.ts";
import { useHeights } from "../use_heights.ts";
import type { StepProps } from "./assistant.ts";
import { StepRegions } from "./step_regions.ts";

export function MeasurementStep({ editor, newest }: StepProps) {
  const { document } = editor;
  const { heights } = useHeights(newest);
  const pitch = pitchOf(newest.result) ?? { x: 1, y: 1 };
  const heightOf = useMemo(() => (heights === null || document === null ? kUnknownHeights : stepHeights(document, heights, pitch)), [heights, document, pitch.x, pitch.y]);
  if (document === null) return html`<p>${t("recipe.no_form")}</p>`;
  const focus = newest.result?.["focus"];
  const size = isObject(focus) ? { x: Number(focus["width_px"]) * pitch.x, y: Number(focus["height_px"]) * pitch.y } : { x: 100, y: 100 };
  const schema = recipeSchema.properties?.["evaluation"]?.properties?.["measurements"] ?? {};
  return html`
    <ul class="offers">${kMeasurements.map((kind) => {
      const missing = regionsMissing(kind, document);
      return html`<li key=${kind}>
        <button type="button" disabled=${missing > 0} aria-describedby=${`offer-${kind}`} onClick=${() => {
          const { path, value } = newMeasurement(kind, document, size, heightOf);
          editor.set(path, value);
        }}>${t(`recipe.measure_${kind}` as TextKey)}</button>
        <span class="help" id=${`offer-${kind}`}>${missing > 0 ? t("recipe.regions_missing", { count: missing }) : t(`recipe.measure_${kind}_help` as TextKey)}</span>
      </li>`;
    })}</ul>
    <${StepRegions} editor=${editor} heightOf=${heightOf}/>
    <div class="recipe-form"><${Field} key=${hasMeasurements(document)} editor=${editor} schema=${schema} path=${["evaluation", "measurements"]} required=${false}/></div>`;
}
