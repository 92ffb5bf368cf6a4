// Which regions each step lies between, in sight: a step between the wrong way round has the wrong sign.
import { number, t, type TextKey } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { isObject } from "../../../recipe/schema.ts";
import { type Editor, namesOf } from "../editor.ts";

export function StepRegions({ editor, heights_um }: { editor: Editor; heights_um: ReadonlyMap<string, number> }) {
  const measurements = getAt(editor.document ?? undefined, ["evaluation", "measurements"]);
  const steps = Object.entries(isObject(measurements) ? measurements : {}).filter(([, value]) => isObject(value) && value["kind"] === "step_between");
  const regions = namesOf(editor, "regions");
  const said = (name: string): string => {
    const height_um = heights_um.get(name);
    return height_um === undefined ? name : `${name} (${number(height_um, 2)} µm)`;
  };
  return html`${steps.map(([name, value]) => {
    const chosen = (which: string): string => (isObject(value) && typeof value[which] === "string" ? value[which] : "");
    const [low, high] = [heights_um.get(chosen("lower")), heights_um.get(chosen("upper"))];
    return html`<fieldset class="field" key=${name}><legend>${name}</legend>
      <div class="add">${["lower", "upper"].map((which) => {
        const own = chosen(which);
        return html`<label>${t(`recipe.region_${which}` as TextKey)}
          <select value=${own} onChange=${(event: Event) => editor.set(["evaluation", "measurements", name, which], (event.target as HTMLSelectElement).value)}>
            ${[...regions, ...(regions.includes(own) ? [] : [own])].map((region) => html`<option value=${region}>${said(region)}</option>`)}
          </select></label>`;
      })}</div>
      ${low !== undefined && high !== undefined && low > high && html`<p class="problem">⚠ ${t("recipe.regions_upside_down")}</p>`}
    </fieldset>`;
  })}`;
}
