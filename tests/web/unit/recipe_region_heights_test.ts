// Which of two regions is the lower one is what the trial's map says, by parallel planes as the daemon measures it.
import assert from "node:assert/strict";
import test from "node:test";
import { hasMeasurements, newMeasurement } from "../../../daemon/web/src/recipe/kinds.ts";
import { heightOfStep, stepHeights } from "../../../daemon/web/src/recipe/region_heights.ts";
import type { Tile } from "../../../daemon/web/src/surface/height_tile.ts";

const pitch = { x: 10, y: 10 };
const size = { x: 160, y: 80 };
const document = {
  evaluation: {
    regions: {
      high: { rectangle_um: { x: 0, y: 0, width: 80, height: 80 } },
      low: { rectangle_um: { x: 80, y: 0, width: 80, height: 80 } },
      outside: { circle_um: { x: 500, y: 500, radius: 3 } },
    },
  },
};

// 8 x 4 samples of 2 x 2 points each, heights in um by their middle's place; a hole in the corner.
function tileOf(height_um: (x_um: number, y_um: number) => number): Tile {
  const mean = new Float32Array(8 * 4).map((_, i) => 1e-6 * height_um((2 * (i % 8) + 1) * pitch.x, (2 * Math.floor(i / 8) + 1) * pitch.y));
  mean[0] = NaN;
  return { kind: "height", window: { x: 0, y: 0, w: 16, h: 8 }, width: 8, height: 4, factor: 2, map_width: 16, map_height: 8, mean, lowest: mean, highest: mean };
}
// The left half is 50 um high.
const step_um = (x: number): number => (x < 80 ? 50 : 0);
const flat = stepHeights(document, tileOf(step_um), pitch);
// As a part that is tilted by 1 : 1 along x, and a little along y: plain means have the left half at 90 um, the right one at 120 um.
const tilted = stepHeights(document, tileOf((x, y) => step_um(x) + x + 0.2 * y), pitch);

const isNear = (found: number | undefined, wanted: number): void => assert.ok(Math.abs((found ?? NaN) - wanted) < 1e-3, `${found}, not ${wanted}`);

test("the height between two regions; what has no valid point is not known", () => {
  isNear(flat("low", "high"), 50);
  isNear(flat("high", "low"), -50);
  assert.equal(flat("low", "outside"), undefined);
  assert.equal(flat("outside", "high"), undefined);
});

test("a tilted part has the same step, by whichever plane; without a slope it is that of the means", () => {
  for (const slope of [undefined, "common_plane", "from_lower", "from_upper"]) isNear(tilted("low", "high", slope), 50);
  assert.ok((tilted("low", "high", "fixed") ?? 0) < 0);
});

test("samples on one line define no slope, and tell nothing", () => {
  const row = (y: number) => ({ rectangle_um: { x: 0, y, width: 160, height: 20 } });
  const regions = { low: row(0), high: row(20) };
  const heightOf = stepHeights({ evaluation: { regions } }, tileOf((x, y) => x + y), pitch);
  assert.equal(heightOf("low", "high"), undefined);
  assert.notEqual(heightOf("low", "high", "fixed"), undefined);
});

test("a step's lower region is the one that lies lower, whatever came first", () => {
  for (const heightOf of [flat, tilted]) {
    assert.deepEqual(newMeasurement("step_between", document, size, heightOf).value, { kind: "step_between", lower: "low", upper: "high" });
  }
  // Where the map does not tell, their order does.
  assert.deepEqual(newMeasurement("step_between", document, size).value, { kind: "step_between", lower: "high", upper: "low" });
});

test("a measurement's own slope counts; of a surface that was made nothing is told", () => {
  const step = { kind: "step_between", lower: "low", upper: "high" };
  isNear(heightOfStep(step, tilted), 50);
  isNear(heightOfStep({ ...step, surface: "measured", slope: "from_upper" }, tilted), 50);
  assert.ok((heightOfStep({ ...step, slope: "fixed" }, tilted) ?? 0) < 0);
  assert.equal(heightOfStep({ ...step, surface: "inverted" }, tilted), undefined);
  assert.equal(heightOfStep({ kind: "step_between" }, tilted), undefined);
});

test("a document without measurements has nothing to judge", () => {
  assert.equal(hasMeasurements({}), false);
  assert.equal(hasMeasurements({ evaluation: { measurements: {} } }), false);
  assert.equal(hasMeasurements({ evaluation: { measurements: { step: { kind: "step_height" } } } }), true);
});
