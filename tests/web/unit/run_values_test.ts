// Values of a result: rows, digits, and where a value lies in its limits.
import assert from "node:assert/strict";
import test from "node:test";
import { limitBar } from "../../../daemon/web/src/run/limit_bar.ts";
import { forPeople, mainHoleReason, rowsOf, verdictOf } from "../../../daemon/web/src/run/value_rows.ts";

const near = (value: number | null | undefined, wanted: number): void =>
  assert.ok(typeof value === "number" && Math.abs(value - wanted) < 1e-9, `${value} is not ${wanted}`);

test("a value between two limits lies in the middle half of the bar", () => {
  const bar = limitBar(50, 0.25, 49, 51);
  assert.ok(bar);
  near(bar.lower, 0.25);
  near(bar.upper, 0.75);
  near(bar.value, 0.5);
  near(bar.from, 0.4375);
  near(bar.to, 0.5625);
  assert.equal(bar.beyond, "no");
});

test("a value far outside stays on the bar and says so", () => {
  assert.equal(limitBar(60, 0.1, 49, 51)?.beyond, "above");
  assert.equal(limitBar(60, 0.1, 49, 51)?.value, 1);
  assert.equal(limitBar(-60, 0.1, 49, 51)?.beyond, "below");
  assert.equal(limitBar(-60, 0.1, 49, 51)?.value, 0);
});

test("a limit that is not there leaves its side open", () => {
  const atMost = limitBar(0.2, null, null, 0.5);
  assert.ok(atMost);
  assert.equal(atMost.lower, null);
  assert.ok(atMost.upper !== null && atMost.upper > atMost.value && atMost.upper < 1);
  assert.equal(atMost.from, atMost.to, "without U there is no interval");
  const atLeast = limitBar(99, 0.5, 102, null);
  assert.ok(atLeast);
  assert.equal(atLeast.upper, null);
  assert.ok(atLeast.lower !== null && atLeast.value < atLeast.lower && atLeast.from >= 0);
});

test("a tolerance of no width, a limit of zero and a wide U are drawn too", () => {
  for (const bar of [limitBar(5, 0, 5, 5), limitBar(0, null, 0, null), limitBar(0, 1e6, null, 0), limitBar(1, 50, 0.9, 1.1)]) {
    assert.ok(bar);
    for (const share of [bar.value, bar.from, bar.to]) assert.ok(share >= 0 && share <= 1, String(share));
  }
});

test("there is no bar without value, or without limit", () => {
  assert.equal(limitBar(null, 1, 0, 1), null);
  assert.equal(limitBar(NaN, 1, 0, 1), null);
  assert.equal(limitBar(1, 1, null, null), null);
});

const evaluated = {
  evaluation: {
    order: ["rough", "step"],
    measurements: {
      step: { main_value: "height_um", values: { height_um: { value: 50, U: 0.2, unit: "um", limits: { lower: 49 }, verdict: "pass" } } },
      rough: {
        main_value: "Sa_um", reason: "too few points",
        values: {
          Sq_um: { value: 0.2, unit: "um" },
          Sa_um: { unit: "um", limits: { upper: 0.5 }, verdict: "invalid" },
          Sdr_percent: { value: 3, unit: "%", limits: {}, verdict: "uncertain" },
        },
      },
    },
  },
};

test("rows: judged ones first, in the recipe's order, a measurement's main value before its others", () => {
  const rows = rowsOf(evaluated);
  assert.deepEqual(rows.map(({ measurement, name }) => `${measurement}.${name}`), ["rough.Sa", "rough.Sdr", "step.height", "rough.Sq"]);
  const [invalid, uncertain, pass, other] = rows;
  assert.deepEqual(invalid, { measurement: "rough", name: "Sa", value: null, unit: "um", U: null, lower: null, upper: 0.5, verdict: "invalid", reason: "too few points" });
  assert.equal(uncertain?.verdict, "uncertain");
  assert.deepEqual([pass?.lower, pass?.upper, pass?.U, pass?.reason], [49, null, 0.2, ""]);
  assert.deepEqual([other?.U, other?.verdict], [null, null]);
});

test("a recipe without evaluation has the map's figures", () => {
  const rows = rowsOf({ measurements: { height_max: { kind: "height", value: 160.9, unit: "um" } } });
  assert.deepEqual(rows.map(({ measurement, name, value, verdict }) => [measurement, name, value, verdict]), [["", "height_max", 160.9, null]]);
});

test("what is no result has no rows", () => {
  for (const nothing of [null, undefined, 7, "x", [], {}, { evaluation: null }, { evaluation: { order: ["gone"], measurements: {} } }, { evaluation: { measurements: { a: null } } }]) {
    assert.deepEqual(rowsOf(nothing), []);
  }
});

test("verdicts by the words of results and of states", () => {
  assert.deepEqual(["ok", "pass", "nok", "fail", "uncertain", "invalid", "undefined", null, "constructor"].map(verdictOf),
    ["pass", "pass", "fail", "fail", "uncertain", "invalid", null, null, null]);
});

test("the reason that most holes have", () => {
  assert.equal(mainHoleReason({ values: { hole_points: { saturated: 3, low_prominence: 70, edge_band: 0 } } }), "low_prominence");
  assert.equal(mainHoleReason({ values: { hole_points: { saturated: 0 } } }), "");
  assert.equal(mainHoleReason(null), "");
});

test("a measurement that is invalid as a whole is a row of its own, with its reason", () => {
  const rows = rowsOf({ evaluation: { measurements: { land: { kind: "areal", reason: "too few points", values: {} }, edge: { main_value: "radius_um", verdict: "invalid", reason: "no edge", values: {} } } } });
  assert.deepEqual(rows.map(({ measurement, name, value, verdict, reason }) => [measurement, name, value, verdict, reason]),
    [["edge", "radius", null, "invalid", "no edge"], ["land", "", null, null, "too few points"]]);
});

test("a figure of the map that has a verdict stands among the values, others only where nothing was measured", () => {
  const measurements = { height_max: { value: 3, unit: "um" }, valid_fraction: { value: 0.07, unit: "1", limits: { lower: 0.9, upper: null }, verdict: "fail" } };
  const rows = rowsOf({ ...evaluated, measurements });
  assert.deepEqual(rows.filter(({ measurement }) => measurement === "").map(({ name, value, lower, upper, verdict }) => [name, value, lower, upper, verdict]), [["valid_fraction", 0.07, 0.9, null, "fail"]]);
  assert.equal(rowsOf({ measurements }).length, 2);
});

test("shares of the map are told in percent, with their limits", () => {
  const [row] = rowsOf({ measurements: { valid_fraction: { value: 0.07, unit: "1", limits: { lower: 0.9, upper: null }, verdict: "fail" } } });
  assert.ok(row);
  const { value, U, lower, upper, unit } = forPeople(row);
  assert.deepEqual([value, U, lower, upper, unit], [7, null, 90, null, "%"]);
  const step = { ...row, measurement: "edge", name: "K" };
  assert.deepEqual(forPeople(step), step, "a ratio that was measured is none");
});
