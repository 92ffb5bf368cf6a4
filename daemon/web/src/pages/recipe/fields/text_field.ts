// A text; of keys that name a region or a surface with the names that there are.
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { namesOf } from "../editor.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame, describedBy, idOf } from "./field_frame.ts";

const kNamesRegion = new Set(["region", "lower", "upper", "not"]);
const kNamesSurface = new Set(["surface", "from"]);

export function TextField({ editor, schema, path, required }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  const key = path[path.length - 1] ?? "";
  if (schema.const !== undefined || key === "$schema") return null;  // the shape's own word, and what is for other editors
  const text = value === undefined ? "" : typeof value === "string" ? value : JSON.stringify(value);
  const input = (event: Event): void => {
    const next = (event.target as HTMLInputElement).value;
    if (next === "" && !required) editor.remove(path);
    else editor.set(path, next);
  };
  const names = kNamesRegion.has(key) ? namesOf(editor, "regions") : kNamesSurface.has(key) ? ["measured", ...namesOf(editor, "surfaces")] : [];
  const id = idOf(path);
  const about = { id, value: text, onInput: input, autocomplete: "off", dir: "auto", ...describedBy(editor, path) };
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required}>
    ${(schema.maxLength ?? 0) > 256
      ? html`<textarea rows="2" ...${about}></textarea>`
      : html`<input list=${names.length > 0 ? `${id}-names` : undefined} placeholder=${schema.default ?? ""} ...${about}/>`}
    ${names.length > 0 && html`<datalist id=${`${id}-names`}>${names.map((name) => html`<option value=${name}/>`)}</datalist>`}
  <//>`;
}
