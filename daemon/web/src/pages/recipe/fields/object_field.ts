// The values of an object, those that the schema knows first; what it does not know is named and stays.
import { useState } from "preact/hooks";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt, pointerOf } from "../../../recipe/document.ts";
import { problemsAt, problemsUnder } from "../../../recipe/problems.ts";
import { type Schema, isObject } from "../../../recipe/schema.ts";
import { Field, type FieldProps } from "./field.ts";
import { idOf } from "./field_frame.ts";
import { helpOf, nameOf } from "./names.ts";

// The fields of an object without a frame of their own.
export function Members({ editor, schema, path }: Omit<FieldProps, "required">) {
  const value = getAt(editor.document ?? undefined, path);
  const known = Object.entries(schema.properties ?? {});
  const others = isObject(value) ? Object.keys(value).filter((key) => !known.some(([name]) => name === key)) : [];
  return html`<div class="members">
    ${known.map(([key, about]) => html`<${Field} key=${key} editor=${editor} schema=${about} path=${[...path, key]}
      required=${schema.required?.includes(key) ?? false}/>`)}
    ${others.map((key) => html`<div class="field" key=${`other-${key}`} id=${idOf([...path, key])} tabindex="-1">
      <p>${key}: <code>${JSON.stringify(isObject(value) ? value[key] : null)}</code></p>
      ${problemsUnder(editor.problems, pointerOf([...path, key])).map((problem) => html`<p class="problem">⚠ ${problem.text}</p>`)}
      <p class="help">${t("recipe.unknown_key")}</p>
      <button type="button" onClick=${() => editor.remove([...path, key])}>${t("recipe.remove_key", { key })}</button>
    </div>`)}
  </div>`;
}

const isWide = (schema: Schema): boolean => Object.keys(schema.properties ?? {}).length > 4;

export function ObjectField({ editor, schema, path }: FieldProps) {
  const key = path[path.length - 1] ?? "";
  const pointer = pointerOf(path);
  const wrong = problemsUnder(editor.problems, pointer).length;
  const own = problemsAt(editor.problems, pointer);
  // What the document says, or what is a few fields, is open; a folded part with problems says how many.
  const [open] = useState(key === "scan" || (!isWide(schema) && getAt(editor.document ?? undefined, path) !== undefined));
  return html`<details class="object" open=${open}>
    <summary id=${idOf(path)}>${nameOf(key)} ${wrong > 0 && html`<span class="problem">⚠ ${t("recipe.problems", { count: wrong })}</span>`}</summary>
    <p class="help">${helpOf(schema)}</p>
    ${own.map((problem) => html`<p class="problem">⚠ ${problem.text}</p>`)}
    <${Members} editor=${editor} schema=${schema} path=${path}/>
  </details>`;
}
