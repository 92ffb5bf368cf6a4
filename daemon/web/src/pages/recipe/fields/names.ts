// Names and sentences of the schema's keys for people. The schema's own words are English; names of keys have a German word,
// and a later key that has none yet is shown by its own.
import { language, t } from "../../../i18n/i18n.ts";
import german from "../../../i18n/recipe_names_de.json" with { type: "json" };
import { html } from "../../../lib/html.ts";
import { type Schema, labelOf } from "../../../recipe/schema.ts";

export function nameOf(key: string): string {
  const words: Record<string, string> = german;
  return (language.get() === "de" && Object.hasOwn(words, key) ? words[key] : undefined) ?? labelOf(key);
}

// The schema says "um" where people read µm.
export const withUnits = (text: string): string => text.replace(/\bum\b/g, "µm").replaceAll("um/s", "µm/s");

export function helpOf(schema: Schema) {
  return schema.description ? html`<span lang="en">${withUnits(schema.description)}${/[.;:]$/.test(schema.description) ? "" : "."}</span>` : null;
}

// How one says a value that stands for a choice.
export const choiceOf = (value: unknown): string =>
  value === true ? t("recipe.yes") : value === false ? t("recipe.no") : String(value);
