// A list in which the order counts: steps of a surface, corners of a polygon.
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt, pointerOf } from "../../../recipe/document.ts";
import { type Json, type Schema, initialOf } from "../../../recipe/schema.ts";
import { problemsAt } from "../../../recipe/problems.ts";
import { Field, type FieldProps } from "./field.ts";
import { idOf } from "./field_frame.ts";
import { helpOf, nameOf } from "./names.ts";

export function ListField({ editor, schema, path }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  const items: Json[] = Array.isArray(value) ? value : [];
  const inner: Schema = schema.items ?? {};
  const key = path[path.length - 1] ?? "";
  const swap = (i: number, j: number): void => {
    const next = [...items];
    [next[i], next[j]] = [next[j] as Json, next[i] as Json];
    editor.set(path, next);
  };
  return html`<fieldset class="field list" id=${idOf(path)} tabindex="-1">
    <legend>${nameOf(key)}</legend>
    ${problemsAt(editor.problems, pointerOf(path)).map((problem) => html`<p class="problem">⚠ ${problem.text}</p>`)}
    <p class="help">${helpOf(schema)}</p>
    <ol>
      ${items.map((_, i) => html`<li key=${i}>
        <${Field} editor=${editor} schema=${inner} path=${[...path, String(i)]} required/>
        <span class="buttons">
          <button type="button" disabled=${i === 0} aria-label=${t("recipe.up", { number: i + 1 })} onClick=${() => swap(i, i - 1)}>↑</button>
          <button type="button" disabled=${i === items.length - 1} aria-label=${t("recipe.down", { number: i + 1 })} onClick=${() => swap(i, i + 1)}>↓</button>
          <button type="button" onClick=${() => editor.remove([...path, String(i)])}>${t("recipe.remove_number", { number: i + 1 })}</button>
        </span>
      </li>`)}
    </ol>
    <button type="button" onClick=${() => editor.set(path, [...items, initialOf(inner)])}>${t("recipe.add_to", { what: nameOf(key) })}</button>
  </fieldset>`;
}
