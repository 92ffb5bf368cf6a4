// Which of two regions is the lower one is what the trial's map says.
import assert from "node:assert/strict";
import test from "node:test";
import { hasMeasurements, newMeasurement } from "../../../daemon/web/src/recipe/kinds.ts";
import { regionHeights } from "../../../daemon/web/src/recipe/region_heights.ts";
import type { Tile } from "../../../daemon/web/src/surface/height_tile.ts";

// 4 x 2 samples of 2 x 2 points each: the left half 50 um high, with a hole, the right one at 0.
const mean = Float32Array.from([50e-6, NaN, 0, 0, 50e-6, 50e-6, 0, 0]);
const tile: Tile = { kind: "height", window: { x: 0, y: 0, w: 8, h: 4 }, width: 4, height: 2, factor: 2, map_width: 8, map_height: 4, mean, lowest: mean, highest: mean };
const pitch = { x: 10, y: 10 };
const document = {
  evaluation: {
    regions: {
      high: { rectangle_um: { x: 0, y: 0, width: 40, height: 40 } },
      low: { rectangle_um: { x: 40, y: 0, width: 40, height: 40 } },
      outside: { circle_um: { x: 500, y: 500, radius: 3 } },
    },
  },
};

test("mean heights by region; what has no valid point is not known", () => {
  const heights_um = regionHeights(document, tile, pitch);
  assert.ok(Math.abs((heights_um.get("high") ?? NaN) - 50) < 1e-3);
  assert.equal(heights_um.get("low"), 0);
  assert.equal(heights_um.has("outside"), false);
});

test("a step's lower region is the one that lies lower, whatever came first", () => {
  const size = { x: 80, y: 40 };
  assert.deepEqual(newMeasurement("step_between", document, size, regionHeights(document, tile, pitch)).value, { kind: "step_between", lower: "low", upper: "high" });
  // Where the map does not tell, their order does.
  assert.deepEqual(newMeasurement("step_between", document, size).value, { kind: "step_between", lower: "high", upper: "low" });
  assert.deepEqual(newMeasurement("step_between", document, size, new Map([["high", 50]])).value, { kind: "step_between", lower: "high", upper: "low" });
});

test("a document without measurements has nothing to judge", () => {
  assert.equal(hasMeasurements({}), false);
  assert.equal(hasMeasurements({ evaluation: { measurements: {} } }), false);
  assert.equal(hasMeasurements({ evaluation: { measurements: { step: { kind: "step_height" } } } }), true);
});
