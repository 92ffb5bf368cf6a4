// Regions and surfaces by other names: what names them follows.
import assert from "node:assert/strict";
import test from "node:test";
import { renameWithUses } from "../../../daemon/web/src/recipe/rename.ts";
import type { Json } from "../../../daemon/web/src/recipe/schema.ts";

// With this name for the region, and for the surface.
const recipe = (region: string, surface = "flat"): Json => ({
  format: 2,
  description: region === "" ? "" : "top",
  evaluation: {
    surfaces: {
      [surface]: { from: "measured", steps: [{ op: "level", regions: ["base", region] }, { op: "invert" }] },
      rough: { from: surface, steps: [] },
    },
    regions: { base: { circle_um: { x: 1, y: 1, radius: 1 } }, [region]: { circle_um: { x: 9, y: 9, radius: 1 } }, rest: { not: region }, both: { union: ["base", region], shrink_um: 1 } },
    measurements: {
      top: { kind: "step_between", lower: "base", upper: region, surface, limits: { height_um: { lower: 1, upper: 2 } } },
      stairs: { kind: "levels", regions: ["base", region, "rest"], limits: { [`${region}-base_um`]: { upper: 2 }, [`rest-${region}_um`]: { upper: 3 }, "rest-base_um": { lower: 0 } } },
      rough: { kind: "areal", region, parameters: ["Sa"], mine: "top" },
    },
  },
});
const text = (document: Json): string => JSON.stringify(document);

test("whatever names a region names it by its new name; nothing else changes, nor any order", () => {
  assert.equal(text(renameWithUses(recipe("top"), ["evaluation", "regions", "top"], "plateau")), text(recipe("plateau")));
});

test("so do measurements and surfaces that are made of a surface", () => {
  assert.equal(text(renameWithUses(recipe("top"), ["evaluation", "surfaces", "flat"], "levelled")), text(recipe("top", "levelled")));
});

test("a name that another one has changes nothing, nor does a name that is nobody's", () => {
  const before = recipe("top");
  assert.equal(renameWithUses(before, ["evaluation", "regions", "top"], "base"), before);
  assert.equal(text(renameWithUses(before, ["evaluation", "regions", "gone"], "new")), text(before));
});

test("a measurement's name is no region's", () => {
  const after = renameWithUses(recipe("top"), ["evaluation", "measurements", "top"], "step") as { evaluation: { regions: object; measurements: Record<string, unknown> } };
  assert.deepEqual(Object.keys(after.evaluation.regions), ["base", "top", "rest", "both"]);
  assert.deepEqual(Object.keys(after.evaluation.measurements), ["step", "stairs", "rough"]);
  assert.deepEqual(after.evaluation.measurements["step"], { kind: "step_between", lower: "base", upper: "top", surface: "flat", limits: { height_um: { lower: 1, upper: 2 } } });
});

test("what is no document of this kind is left as it is", () => {
  assert.deepEqual(renameWithUses({ evaluation: { regions: { a: 1 }, measurements: [7], surfaces: null } }, ["evaluation", "regions", "a"], "b"), { evaluation: { regions: { b: 1 }, measurements: [7], surfaces: null } });
});
