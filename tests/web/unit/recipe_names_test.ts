import assert from "node:assert/strict";
import test from "node:test";
import german from "../../../daemon/web/src/i18n/recipe_names_de.json" with { type: "json" };
import { type Schema, recipeSchema } from "../../../daemon/web/src/recipe/schema.ts";

function keysOf(schema: Schema, found: Set<string>): Set<string> {
  for (const [key, about] of Object.entries(schema.properties ?? {})) {
    // The word that tells a shape is shown in place of its key.
    if (about.const !== undefined) found.add(about.const);
    else found.add(key);
    keysOf(about, found);
  }
  if (typeof schema.additionalProperties === "object") keysOf(schema.additionalProperties, found);
  if (schema.items) keysOf(schema.items, found);
  for (const shape of schema.oneOf ?? []) keysOf(shape, found);
  return found;
}

test("every key of a recipe has a German name, and no name is left over", () => {
  const keys = keysOf(recipeSchema, new Set());
  const same = new Set(["$schema", "x", "y"]);  // of both languages, or not shown
  assert.deepEqual([...keys].filter((key) => !same.has(key) && !(key in german)), []);
  assert.deepEqual(Object.keys(german).filter((key) => !keys.has(key)), []);
});
