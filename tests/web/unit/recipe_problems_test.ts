import assert from "node:assert/strict";
import test from "node:test";
import { ancestors, offsetOf, placeOf, problemsAt, problemsOf, problemsUnder } from "../../../daemon/web/src/recipe/problems.ts";

test("every line of a refusal is a problem at its place", () => {
  const problems = problemsOf("recipe groove: /acquire/scan/step_um: -1 is not accepted; expected a number above 0\nrecipe groove: /evaluation/measurements/a b/regions: is missing: no default");
  assert.deepEqual(problems, [
    { pointer: "/acquire/scan/step_um", text: "-1 is not accepted; expected a number above 0" },
    { pointer: "/evaluation/measurements/a b/regions", text: "is missing: no default" },
  ]);
  assert.equal(problemsAt(problems, "/acquire/scan/step_um").length, 1);
  assert.equal(problemsAt(problems, "/acquire/scan").length, 0);
  assert.equal(problemsUnder(problems, "/acquire").length, 1);
  assert.equal(problemsUnder(problems, "/acq").length, 0);
});

test("of a text that is no JSON the place is line and column", () => {
  const [problem] = problemsOf("recipe checked: no valid JSON at line 2, column 3: syntax error");
  assert.deepEqual(problem, { pointer: null, text: "no valid JSON at line 2, column 3: syntax error", line: 2, column: 3 });
  assert.equal(offsetOf("ab\ncdef\n", 2, 3), 5);
  assert.equal(offsetOf("ab", 9, 9), 2);
});

test("nothing is no problem", () => {
  assert.deepEqual(problemsOf(null), []);
  assert.deepEqual(problemsOf(""), []);
});

test("what has no field is shown at what it lies in", () => {
  assert.deepEqual(ancestors("/a/b~1c/0"), ["/a/b~1c/0", "/a/b~1c", "/a"]);
});

test("a pointer's place in a text, past texts that look like keys", () => {
  const text = '{ "x": "\\"a\\": {", "list": [1, [2, {"b": 3}]], "a": { "b~": 4, "c/d": [5, 6] } }';
  assert.equal(text.slice(placeOf(text, "/a/b~0")).startsWith('"b~": 4'), true);
  assert.equal(text.slice(placeOf(text, "/a/c~1d/1")).startsWith("6]"), true);
  assert.equal(text.slice(placeOf(text, "/list/1/1/b")).startsWith('"b": 3'), true);
  assert.equal(placeOf(text, "/a/none"), -1);
  assert.equal(placeOf("{", "/a"), -1);
});
