// Several words of a list: those of the schema, or the names of regions.
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { namesOf } from "../editor.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame } from "./field_frame.ts";

export function NamesField({ editor, schema, path, required }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  const chosen = Array.isArray(value) ? value.map(String) : [];
  const offered = schema.items?.enum ?? namesOf(editor, "regions").filter((name) => name !== path[path.length - 2]);
  // What is chosen and is not on offer is shown, too: it must be possible to take it away.
  const all = [...offered, ...chosen.filter((each) => !offered.includes(each))];
  const toggle = (word: string): void => {
    // The order of the document stays; a new word is the last.
    const next = chosen.includes(word) ? chosen.filter((each) => each !== word) : [...chosen, word];
    if (next.length === 0 && !required) editor.remove(path);
    else editor.set(path, next);
  };
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required} group>
    <div class="words">
      ${all.map((word) => html`<label class="word"><input type="checkbox" checked=${chosen.includes(word)} onChange=${() => toggle(word)}/> ${word}</label>`)}
      ${all.length === 0 && html`<span class="help">${t("recipe.no_regions")}</span>`}
    </div>
  <//>`;
}
