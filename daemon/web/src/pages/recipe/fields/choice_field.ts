// One of several words, or yes and no. Nothing chosen is the default, and is not written.
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame, describedBy, idOf } from "./field_frame.ts";
import { choiceOf } from "./names.ts";

export function ChoiceField({ editor, schema, path, required }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  const choices: readonly (string | boolean)[] = schema.enum ?? [true, false];
  const known = value === undefined || choices.some((each) => each === value);
  const shown = value === undefined ? "" : known ? String(value) : "?";
  const change = (event: Event): void => {
    const text = (event.target as HTMLSelectElement).value;
    const chosen = choices.find((each) => String(each) === text);
    if (chosen === undefined) editor.remove(path);
    else editor.set(path, chosen);
  };
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required}>
    <select id=${idOf(path)} value=${shown} onChange=${change} ...${describedBy(editor, path)}>
      ${(!required || value === undefined) && html`<option value="">${schema.default === undefined ? t("recipe.absent") : t("recipe.default", { value: choiceOf(schema.default) })}</option>`}
      ${!known && html`<option value="?" disabled>${JSON.stringify(value)}</option>`}
      ${choices.map((each) => html`<option value=${String(each)}>${choiceOf(each)}</option>`)}
    </select>
  <//>`;
}
