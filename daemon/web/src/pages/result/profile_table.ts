// The profile as a table: what the curve shows, for those who do not see it, and for a spreadsheet.
import { useState } from "preact/hooks";
import { number, t } from "../../i18n/i18n.ts";
import { download } from "../../lib/download.ts";
import { html } from "../../lib/html.ts";
import type { Profile } from "../../surface/profile_line.ts";

const kRows = 500;  // more are for a file, not for reading

// Machine values: a point for the decimal sign, an empty cell for a hole.
function profileCsv({ distance_um, height_um, sigma_um }: Profile): string {
  const rows = distance_um.map((x, i) => `${x},${height_um[i] ?? ""},${Number.isNaN(sigma_um[i]) ? "" : (sigma_um[i] ?? "")}`);
  return `distance_um,height_um,sigma_um\r\n${rows.join("\r\n")}\r\n`;
}

export function ProfileTable({ profile, unit, name }: { profile: Profile; unit: string; name: string }) {
  const [isOpen, setOpen] = useState(false);
  const count = profile.distance_um.length;
  const every = Math.max(1, Math.ceil(count / kRows));
  const cell = (value: number | null | undefined, hole: string): string => (value === null || value === undefined || Number.isNaN(value) ? hole : number(value, 4));
  return html`<details onToggle=${(event: Event) => setOpen((event.target as HTMLDetailsElement).open)}>
    <summary>${t("result.profile.table")}</summary>
    ${isOpen && html`<p><button type="button" onClick=${() => download(name, "text/csv", profileCsv(profile))}>${t("result.profile.csv")}</button></p>
      ${every > 1 && html`<p class="help">${t("result.profile.every", { n: number(every) })}</p>`}
      <div class="scroll profile-table" tabindex="0" role="region" aria-label=${t("result.profile.table")}><table>
        <thead><tr><th class="number" scope="col">${t("result.axis.along", { unit })}</th><th class="number" scope="col">${t("result.axis.height")}</th>
          <th class="number" scope="col">σ / µm</th></tr></thead>
        <tbody>${profile.distance_um.map((x, i) => i % every === 0 && html`<tr><td class="number">${number(x, 3)}</td>
          <td class="number">${cell(profile.height_um[i], t("result.hole"))}</td><td class="number">${cell(profile.sigma_um[i], "–")}</td></tr>`)}</tbody>
      </table></div>`}
  </details>`;
}
