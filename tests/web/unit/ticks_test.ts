import assert from "node:assert/strict";
import test from "node:test";
import { barLength, roundBelow, ticks } from "../../../daemon/web/src/surface/ticks.ts";

test("round numbers below a wish", () => {
  assert.deepEqual([1, 1.99, 2, 4.9, 5, 9.9, 10, 0.3, 1000].map(roundBelow), [1, 1, 2, 2, 5, 5, 10, 0.2, 1000]);
  assert.deepEqual([5.4, 4.99, 0.5, 0.2, 0.1, 0.05, 0.0012, 54].map(roundBelow), [5, 2, 0.5, 0.2, 0.1, 0.05, 0.001, 50], "as people write them, not 0.05000000000000001");
  assert.equal(roundBelow(0), 1);
  assert.equal(roundBelow(NaN), 1);
  assert.equal(barLength(170), 100);
});

test("ticks lie within, are round, and not too many", () => {
  assert.deepEqual(ticks(69.4, 120.7, 6), { values: [70, 80, 90, 100, 110, 120], digits: 0 });
  assert.deepEqual(ticks(-0.25, 0.25, 3), { values: [-0.2, 0, 0.2], digits: 1 });
  for (const [low, high] of [[0, 1], [-1e-4, 3e-3], [99999, 100001], [-7, 1e6]] as const) {
    for (const most of [2, 3, 5, 9]) {
      const { values } = ticks(low, high, most);
      assert.ok(values.length <= most, `${low}..${high} ${most}: ${values}`);
      assert.ok(values.every((value) => value >= low - 1e-9 && value <= high + 1e-9), `${values}`);
    }
  }
});

test("a range without width has one tick or none", () => {
  assert.deepEqual(ticks(5, 5, 6).values, [5]);
  assert.deepEqual(ticks(NaN, NaN, 6).values, []);
});
