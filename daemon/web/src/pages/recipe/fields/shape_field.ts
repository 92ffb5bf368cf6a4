// An object of one of several shapes: which one, and its fields.
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt, pointerOf } from "../../../recipe/document.ts";
import { problemsAt } from "../../../recipe/problems.ts";
import { type JsonObject, initialOf, isObject, nameOfShape, shapeOf } from "../../../recipe/schema.ts";
import type { FieldProps } from "./field.ts";
import { idOf } from "./field_frame.ts";
import { nameOf } from "./names.ts";
import { Members } from "./object_field.ts";

export function ShapeField({ editor, schema, path }: FieldProps) {
  const shapes = schema.oneOf ?? [];
  const value = getAt(editor.document ?? undefined, path);
  const at = shapeOf(shapes, value);
  const shape = shapes[at];
  const change = (event: Event): void => {
    const next = shapes[Number((event.target as HTMLSelectElement).value)];
    if (!next) return;
    const made = initialOf(next) as JsonObject;
    // What both shapes have stays, except the word that tells them apart.
    const kept = isObject(value) ? Object.entries(value).filter(([key]) => next.properties?.[key] && next.properties[key]?.const === undefined) : [];
    editor.set(path, { ...made, ...Object.fromEntries(kept) });
  };
  const id = idOf(path);
  return html`<div class="shape" id=${id} tabindex="-1">
    <label for=${`${id}-shape`}>${t("recipe.shape")}</label>
    <select id=${`${id}-shape`} value=${String(at)} onChange=${change}>
      ${at < 0 && html`<option value="-1" disabled>${t("recipe.shape_unknown")}</option>`}
      ${shapes.map((each, i) => html`<option value=${String(i)}>${nameOf(nameOfShape(each))}</option>`)}
    </select>
    ${problemsAt(editor.problems, pointerOf(path)).map((problem) => html`<p class="problem">⚠ ${problem.text}</p>`)}
    ${shape ? html`<${Members} key=${nameOfShape(shape)} editor=${editor} schema=${shape} path=${path}/>` : html`<pre>${JSON.stringify(value)}</pre>`}
  </div>`;
}
