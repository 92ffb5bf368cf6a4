// What the document has other than the saved one, value by value.
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { Change } from "../../recipe/difference.ts";
import type { Json } from "../../recipe/schema.ts";
import { goToField } from "./check_state.ts";

const said = (value: Json | undefined): string => (value === undefined ? "–" : JSON.stringify(value));

export function DifferenceList({ changes }: { changes: readonly Change[] | null }) {
  if (changes === null) return html`<p>${t("recipe.no_form")}</p>`;
  if (changes.length === 0) return html`<p>${t("recipe.no_difference")}</p>`;
  return html`<div class="scroll"><table>
    <thead><tr><th>${t("recipe.where")}</th><th>${t("recipe.saved_value")}</th><th>${t("recipe.draft_value")}</th></tr></thead>
    <tbody>${changes.map((change) => html`<tr>
      <td><button type="button" class="place" onClick=${() => goToField(change.pointer)}><code>${change.pointer || "/"}</code></button></td>
      <td><del>${said(change.before)}</del></td>
      <td><ins>${said(change.after)}</ins></td>
    </tr>`)}</tbody>
  </table></div>`;
}
