// The form: the schema's parts in groups. What a later schema has more is in the last group by itself.
import { t, type TextKey } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { recipeSchema } from "../../recipe/schema.ts";
import type { Editor } from "./editor.ts";
import { Field } from "./fields/field.ts";
import { Members } from "./fields/object_field.ts";

const kGroups: readonly (readonly [string, readonly string[]])[] = [
  ["general", ["description"]],
  ["acquire", ["acquire"]],
  ["reconstruct", ["reconstruct"]],
  ["evaluation", ["evaluation"]],
  ["output", ["export", "report", "keep"]],
];

export function RecipeForm({ editor }: { editor: Editor }) {
  if (editor.document === null) return html`<p class="panel problem">${t("recipe.no_form")}</p>`;
  const parts = recipeSchema.properties ?? {};
  const grouped = new Set(kGroups.flatMap(([, keys]) => keys));
  const rest = Object.keys(parts).filter((key) => !grouped.has(key));
  const unknown = Object.keys(editor.document).filter((key) => !Object.hasOwn(parts, key));
  return html`<form class="recipe-form" onSubmit=${(event: Event) => event.preventDefault()}>
    ${[...kGroups, ["other", rest] as const].map(([group, keys]) => html`<section class="panel" key=${group}>
      <h2>${t(`recipe.group_${group}` as TextKey)}</h2>
      ${keys.map((key) => {
        const about = parts[key];
        if (!about) return null;
        // A group of one part needs no second heading.
        return keys.length === 1 && about.type === "object"
          ? html`<${Members} editor=${editor} schema=${about} path=${[key]}/>`
          : html`<${Field} key=${key} editor=${editor} schema=${about} path=${[key]} required=${recipeSchema.required?.includes(key) ?? false}/>`;
      })}
      ${group === "other" && unknown.length > 0 && html`<${Members} editor=${editor} schema=${{ properties: {} }} path=${[]}/>`}
    </section>`)}
  </form>`;
}
