// What is around every input: its name and unit, its sentence, range and default, and what the checker says of it.
import type { ComponentChildren } from "preact";
import { number, t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { type Path, pointerOf } from "../../../recipe/document.ts";
import { problemsAt } from "../../../recipe/problems.ts";
import { type Schema, rangeOf, unitOf } from "../../../recipe/schema.ts";
import type { Editor } from "../editor.ts";
import { helpOf, nameOf } from "./names.ts";

// Ids of elements have no blanks; the names in a pointer may.
export const idOf = (path: Path): string => `field-${encodeURIComponent(pointerOf(path))}`;

export function describedBy(editor: Editor, path: Path): { "aria-describedby": string; "aria-invalid"?: "true" } {
  const id = idOf(path);
  const wrong = problemsAt(editor.problems, pointerOf(path)).length > 0;
  return { "aria-describedby": wrong ? `${id}-problem ${id}-help` : `${id}-help`, ...(wrong ? { "aria-invalid": "true" as const } : {}) };
}

function defaultOf(schema: Schema, required: boolean): string {
  if (required) return t("recipe.required");
  const value = schema.default;
  if (value === undefined) return "";
  if (value === "") return "";
  if (typeof value === "number") return t("recipe.default", { value: number(value) });
  if (typeof value === "boolean") return t("recipe.default", { value: t(value ? "recipe.yes" : "recipe.no") });
  if (Array.isArray(value)) return value.length === 0 ? "" : t("recipe.default", { value: value.join(", ") });
  return t("recipe.default", { value: String(value) });
}

export function FieldFrame({ editor, schema, path, required, group, children }: {
  editor: Editor;
  schema: Schema;
  path: Path;
  required: boolean;
  group?: boolean;  // several inputs: a fieldset with a legend in place of a label
  children: ComponentChildren;
}) {
  const id = idOf(path);
  const key = path[path.length - 1] ?? "";
  const unit = unitOf(key);
  const name = html`${nameOf(key)}${unit && html` <span class="unit">${unit}</span>`}`;
  const range = schema.type === "number" || schema.type === "integer" ? rangeOf(schema, number) : "";
  const facts = [range, defaultOf(schema, required)].filter((each) => each !== "").join(" · ");
  const problems = problemsAt(editor.problems, pointerOf(path));
  const inner = html`
    ${children}
    ${problems.map((problem, i) => html`<p class="problem" id=${i === 0 ? `${id}-problem` : undefined}>⚠ ${problem.text}</p>`)}
    <p class="help" id=${`${id}-help`}>${helpOf(schema)} ${facts && html`<span class="facts">${facts}</span>`}</p>`;
  if (group) return html`<fieldset class="field" id=${id} tabindex="-1"><legend>${name}</legend>${inner}</fieldset>`;
  return html`<div class="field"><label for=${id}>${name}</label>${inner}</div>`;
}
