// Which regions each step lies between, in sight: a step between the wrong way round has the wrong sign.
import { number, t, type TextKey } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { type StepHeight, heightOfStep } from "../../../recipe/region_heights.ts";
import { isObject } from "../../../recipe/schema.ts";
import { type Editor, namesOf } from "../editor.ts";

export function StepRegions({ editor, heightOf }: { editor: Editor; heightOf: StepHeight }) {
  const measurements = getAt(editor.document ?? undefined, ["evaluation", "measurements"]);
  const steps = Object.entries(isObject(measurements) ? measurements : {}).filter(([, value]) => isObject(value) && value["kind"] === "step_between");
  const regions = namesOf(editor, "regions");
  return html`${steps.map(([name, value]) => {
    const chosen = (which: string): string => (isObject(value) && typeof value[which] === "string" ? value[which] : "");
    const height_um = heightOfStep(value, heightOf);
    return html`<fieldset class="field" key=${name}><legend>${name}</legend>
      <div class="add">${["lower", "upper"].map((which) => {
        const own = chosen(which);
        return html`<label>${t(`recipe.region_${which}` as TextKey)}
          <select value=${own} onChange=${(event: Event) => editor.set(["evaluation", "measurements", name, which], (event.target as HTMLSelectElement).value)}>
            ${[...regions, ...(regions.includes(own) ? [] : [own])].map((region) => html`<option value=${region}>${region}</option>`)}
          </select></label>`;
      })}</div>
      ${height_um !== undefined && html`<p class="help">${t("recipe.step_in_trial", { height: number(height_um, 2) })}</p>`}
      ${height_um !== undefined && height_um < 0 && html`<p class="problem">⚠ ${t("recipe.regions_upside_down")}</p>`}
    </fieldset>`;
  })}`;
}
