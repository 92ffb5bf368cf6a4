// What is measured by where nobody chose a recipe.
import assert from "node:assert/strict";
import { test } from "node:test";
import { offered, recipeToStart } from "../../../daemon/web/src/run/recipe_choice.ts";

const known = ["try_groove", "anvil", "groove"];
const of = (more: Partial<Parameters<typeof recipeToStart>[0]>): string => recipeToStart({ choice: null, measured: [], known, ...more });

test("what was chosen, else the prepared one, else that of the newest job, else the first", () => {
  assert.equal(of({ choice: "groove", prepared: "anvil" }), "groove");
  assert.equal(of({ prepared: "groove", measured: ["anvil"] }), "groove");
  assert.equal(of({ measured: ["groove", "anvil"] }), "groove");
  assert.equal(of({}), "anvil");
  assert.equal(of({ choice: "gone", prepared: "lost", measured: ["", "groove"] }), "groove", "those that are not there any more do not count");
});

test("a draft of trial scans is measured by only where somebody chose it", () => {
  assert.equal(of({ prepared: "try_groove", measured: ["try_groove", "groove"] }), "groove");
  assert.equal(of({ prepared: "try_groove" }), "anvil");
  assert.equal(of({ choice: "try_groove" }), "try_groove");
  assert.equal(recipeToStart({ choice: null, prepared: "try_a", measured: ["try_a"], known: ["try_a"] }), "");
  assert.equal(recipeToStart({ choice: null, prepared: "try_a", measured: ["b"], known: null }), "b");
  assert.equal(recipeToStart({ choice: null, measured: [], known: [] }), "");
});

test("drafts stand last, the others as they were", () => {
  assert.deepEqual(offered(known), ["anvil", "groove", "try_groove"]);
});
