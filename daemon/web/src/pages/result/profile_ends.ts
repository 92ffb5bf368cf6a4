// The profile's two ends and its band, typed.
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { ProfileLine } from "../../surface/profile_line.ts";
import { NumberField } from "./number_field.ts";
import type { ResultMap } from "./use_map.ts";

export function ProfileEnds({ map, line, onLine }: { map: ResultMap; line: ProfileLine; onLine: (line: ProfileLine) => void }) {
  const { size, unit } = map;
  const most = { x: size.width * size.pitch_x, y: size.height * size.pitch_y };
  return html`<div class="controls">
    ${([["from", "A"], ["to", "B"]] as const).map(([end, name]) => (["x", "y"] as const).map((axis) => html`
      <${NumberField} label=${`${name} ${axis}`} unit=${unit} value=${line[end][axis]} digits=${2} least=${0} most=${most[axis]}
        onChange=${(value: number) => onLine({ ...line, [end]: { ...line[end], [axis]: value } })}/>`))}
    <${NumberField} label=${t("result.profile.width")} unit=${unit} value=${line.width_um} digits=${2} least=${0} most=${Math.max(most.x, most.y)}
      onChange=${(width_um: number) => onLine({ ...line, width_um })}/>
  </div>`;
}
