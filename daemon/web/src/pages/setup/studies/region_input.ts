// The part of the field that counts: all of it, a rectangle, or a circle.
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { type Faults, type Region, kRegionNumbers } from "./study_values.ts";

interface Props {
  id: string;
  name: string;
  region: Region;
  faults: Faults;
  describedBy: string;
  change: (region: Region) => void;
}

export function RegionInput({ id, name, region, faults, describedBy, change }: Props) {
  useLanguage();
  const numbers = region.shape === "" ? [] : kRegionNumbers[region.shape];
  return html`<div>
    <select id=${id} value=${region.shape} aria-describedby=${describedBy}
      onChange=${(event: Event) => change({ ...region, shape: (event.target as HTMLSelectElement).value as Region["shape"] })}>
      <option value="">${t("setup.region.all")}</option>
      <option value="rectangle_um">${t("setup.region.rectangle")}</option>
      <option value="circle_um">${t("setup.region.circle")}</option>
    </select>
    <div class="fields">
      ${numbers.map((each) => html`<label class="field" key=${each}>${tWord("setup.region", each)} (µm)
        <input class="short" inputmode="text" value=${region.numbers[each] ?? ""} aria-invalid=${`${name}.${each}` in faults}
          onInput=${(event: Event) => change({ ...region, numbers: { ...region.numbers, [each]: (event.target as HTMLInputElement).value } })}/></label>`)}
    </div>
  </div>`;
}
