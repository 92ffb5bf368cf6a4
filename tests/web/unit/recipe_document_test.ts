import assert from "node:assert/strict";
import test from "node:test";
import { differences } from "../../../daemon/web/src/recipe/difference.ts";
import { freeName, getAt, pathOf, pointerOf, removeAt, renameAt, setAt } from "../../../daemon/web/src/recipe/document.ts";
import { formatJson } from "../../../daemon/web/src/recipe/format_json.ts";
import { freeId, idFrom, isId, tryId } from "../../../daemon/web/src/recipe/ids.ts";
import { type Json, initialOf, isObject, labelOf, nameOfShape, rangeOf, recipeSchema, shapeOf, unitOf } from "../../../daemon/web/src/recipe/schema.ts";

const json = (text: string): Json => JSON.parse(text) as Json;

test("a pointer and its path are the same place, with slashes and tildes in names", () => {
  assert.equal(pointerOf(["a/b", "c~d", ""]), "/a~1b/c~0d/");
  assert.deepEqual(pathOf("/a~1b/c~0d/"), ["a/b", "c~d", ""]);
  assert.deepEqual(pathOf(""), []);
});

test("a change keeps unknown keys, the order of keys and the document it was made from", () => {
  const before = json('{"z": 1, "mine": {"x": [1, {"y": 2}]}, "a": 3}');
  const after = setAt(before, ["mine", "x", "1", "y"], 5);
  assert.equal(JSON.stringify(after), '{"z":1,"mine":{"x":[1,{"y":5}]},"a":3}');
  assert.equal(JSON.stringify(before), '{"z":1,"mine":{"x":[1,{"y":2}]},"a":3}');
});

test("objects on the way are made", () => {
  assert.deepEqual(setAt({}, ["a", "b"], 1), { a: { b: 1 } });
  assert.deepEqual(setAt("text", ["a"], 1), { a: 1 });
});

test("names of the language itself are keys as all others", () => {
  const made = setAt({}, ["__proto__"], 1);
  assert.equal(JSON.stringify(made), '{"__proto__":1}');
  assert.equal(getAt({}, ["constructor"]), undefined);
  assert.equal(getAt({}, ["toString", "name"]), undefined);
  assert.deepEqual(differences({}, json('{"__proto__": 1}')), [{ pointer: "/__proto__", before: undefined, after: 1 }]);
});

test("what is taken away leaves its neighbours; what is not there cannot go", () => {
  const document = json('{"a": {"b": 1, "c": 2}, "d": [1, 2, 3]}');
  assert.deepEqual(removeAt(document, ["a", "b"]), { a: { c: 2 }, d: [1, 2, 3] });
  assert.deepEqual(removeAt(document, ["d", "1"]), { a: { b: 1, c: 2 }, d: [1, 3] });
  assert.deepEqual(removeAt(document, ["a", "x", "y"]), document);
});

test("a new name keeps the place; a taken one changes nothing", () => {
  const document = json('{"r": {"a": 1, "b": 2, "c": 3}}');
  assert.equal(JSON.stringify(renameAt(document, ["r", "b"], "x")), '{"r":{"a":1,"x":2,"c":3}}');
  assert.equal(renameAt(document, ["r", "b"], "c"), document);
  assert.equal(freeName(getAt(document, ["r"]), "a"), "a_2");
  assert.equal(freeName(undefined, "a"), "a");
});

test("differences are told value by value, whatever the order of keys", () => {
  const before = json('{"a": 1, "b": {"c": [1, 2], "d": "x"}, "e": null}');
  const after = json('{"e": null, "b": {"d": "y", "c": [1, 3]}, "f": true}');
  assert.deepEqual(differences(before, after), [
    { pointer: "/a", before: 1, after: undefined },
    { pointer: "/b/c/1", before: 2, after: 3 },
    { pointer: "/b/d", before: "x", after: "y" },
    { pointer: "/f", before: undefined, after: true },
  ]);
  assert.deepEqual(differences([1, 2], [1]), [{ pointer: "", before: [1, 2], after: [1] }]);
  assert.deepEqual(differences(0, -0), []);
});

test("what is formatted is read back the same", () => {
  const document = json('{"a": [], "b": {}, "c": [[1, 2], [3, 4]], "d": {"e": {"f": {"g": {"h": "µ\\u2028\\""}}}}, "n": 1e-7}');
  assert.deepEqual(JSON.parse(formatJson(document)), document);
  assert.ok(formatJson(document).endsWith("}\n"));
  assert.ok(formatJson({ long: Array.from({ length: 100 }, (_, i) => i) }).split("\n").length > 50);
});

test("the schema's shapes are told apart by their own word", () => {
  const regions = recipeSchema.properties?.["evaluation"]?.properties?.["regions"]?.additionalProperties;
  assert.ok(isObject(regions));
  const shapes = recipeSchema.properties?.["evaluation"]?.properties?.["measurements"]?.additionalProperties;
  const kinds = (typeof shapes === "object" ? shapes.oneOf ?? [] : []).map(nameOfShape);
  assert.ok(kinds.includes("step_height") && kinds.includes("cutting_edge"));
  const areal = typeof shapes === "object" ? shapes.oneOf ?? [] : [];
  assert.equal(kinds[shapeOf(areal, { kind: "areal", parameters: [] })], "areal");
  assert.equal(shapeOf(areal, { kind: "no such" }), -1);
  assert.equal(shapeOf(areal, null), -1);
});

test("a new value has what its schema requires", () => {
  const scan = recipeSchema.properties?.["acquire"]?.properties?.["scan"];
  assert.deepEqual(initialOf(scan ?? {}), { start_um: 0, step_um: 1, slices: 3 });
  assert.deepEqual(initialOf({ type: "array", minItems: 2, items: { type: "number", exclusiveMinimum: 0 } }), [1, 1]);
});

test("names, units and ranges for people", () => {
  assert.equal(unitOf("speed_um_per_s"), "µm/s");
  assert.equal(unitOf("step_um"), "µm");
  assert.equal(unitOf("slices"), "");
  assert.equal(labelOf("max_blur_steps"), "Max blur steps");
  assert.equal(labelOf("exposure_us"), "Exposure");
  assert.equal(rangeOf({ exclusiveMinimum: 0, maximum: 10 }, String), "> 0 … 10");
  assert.equal(rangeOf({ maximum: 10 }, String), "≤ 10");
  assert.equal(rangeOf({}, String), "");
});

test("ids of recipes", () => {
  assert.ok(isId("groove_2-b") && !isId("") && !isId("a b") && !isId("a".repeat(33)) && !isId("../x"));
  assert.equal(idFrom("My groove (2).json"), "My_groove_2_");
  assert.equal(idFrom("…"), "_");
  assert.equal(freeId("a", ["a", "a_2"]), "a_3");
  assert.ok(isId(freeId("b".repeat(32), ["b".repeat(32)])));
  assert.ok(isId(tryId("c".repeat(32))));
});
