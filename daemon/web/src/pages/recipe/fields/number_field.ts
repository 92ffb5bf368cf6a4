// A number, with what is to be said of it.
import { number } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame, describedBy, idOf } from "./field_frame.ts";
import { NumberInput } from "./number_input.ts";

export function NumberField({ editor, schema, path, required }: FieldProps) {
  const about = { id: idOf(path), placeholder: typeof schema.default === "number" ? number(schema.default) : "", ...describedBy(editor, path) };
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required}>
    <${NumberInput} editor=${editor} path=${path} about=${about}/>
  <//>`;
}
