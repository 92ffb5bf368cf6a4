// A number. What is no number goes into the document as it was typed: the daemon's checker then says what it expects.
import { useState } from "preact/hooks";
import { number } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { readNumber } from "../../../lib/read_number.ts";
import { getAt } from "../../../recipe/document.ts";
import type { Json } from "../../../recipe/schema.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame, describedBy, idOf } from "./field_frame.ts";

export const valueOfText = (text: string): Json | undefined => (text.trim() === "" ? undefined : readNumber(text) ?? text);

export function textOfValue(value: Json | undefined): string {
  if (value === undefined) return "";
  return typeof value === "number" ? number(value) : typeof value === "string" ? value : JSON.stringify(value);
}

export function NumberField({ editor, schema, path, required }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  // "1," is on its way to "1,5": what was typed stands as long as it means what the document has.
  const [typed, setTyped] = useState("");
  const shown = value !== undefined && Object.is(valueOfText(typed), value) ? typed : textOfValue(value);
  const input = (event: Event): void => {
    const text = (event.target as HTMLInputElement).value;
    setTyped(text);
    const next = valueOfText(text);
    if (next === undefined) editor.remove(path);
    else editor.set(path, next);
  };
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required}>
    <input id=${idOf(path)} class="number" inputmode="decimal" autocomplete="off" value=${shown} onInput=${input}
      placeholder=${typeof schema.default === "number" ? number(schema.default) : ""} ...${describedBy(editor, path)}/>
  <//>`;
}
