import assert from "node:assert/strict";
import test from "node:test";
import { kViridisTable } from "../../../daemon/web/src/surface/colours.ts";
import { meshOf, shade, slopesAt, trianglesOf } from "../../../daemon/web/src/surface/height_mesh.ts";
import { reliefPixels } from "../../../daemon/web/src/surface/relief.ts";
import { boundedLook, matrixOf, restAfter_ms, suggestedExaggeration } from "../../../daemon/web/src/surface/view_angles.ts";

const tileOf = (mean: Float32Array, width: number, height: number, factor = 1, map_width = width * factor, map_height = height * factor) =>
  ({ kind: "height" as const, mean, lowest: mean, highest: mean, width, height, factor, map_width, map_height, window: { x: 0, y: 0, w: map_width, h: map_height } });

test("two triangles a square, one where a corner is missing, none where two are", () => {
  assert.equal(trianglesOf(new Float32Array(6), 3, 2).length, 12);
  const wide = trianglesOf(new Float32Array(40 * 3), 40, 3);  // more than a stripe, and no whole number of them
  assert.equal(new Set(Array.from({ length: wide.length / 3 }, (_, i) => wide.slice(3 * i, 3 * i + 3).join())).size, 2 * 39 * 2);
  for (let hole = 0; hole < 4; ++hole) {
    const heights = new Float32Array(4);
    heights[hole] = NaN;
    const triangles = [...trianglesOf(heights, 2, 2)];
    assert.equal(triangles.length, 3);
    assert.ok(!triangles.includes(hole));
  }
  assert.equal(trianglesOf(new Float32Array([NaN, 1, NaN, 1]), 2, 2).length, 0);
  assert.equal(trianglesOf(new Float32Array(5), 5, 1).length, 0);
});

test("the first row is at the back and the first column at the left, about the middle", () => {
  const mesh = meshOf(tileOf(new Float32Array([1e-6, 2e-6, 3e-6, NaN]), 2, 2, 10, 20, 15), new Float32Array(4), { low: 0, high: 1 }, kViridisTable,
    { pitch_x: 2, pitch_y: 2 }, 1);
  // Rows stand for 10 and for 5 points: middles 5 and 12.5 of 15.
  assert.deepEqual([...mesh.positions].map((value) => Number(value.toFixed(4))), [-10, 5, 1, 10, 5, 2, -10, -10, 3, 10, -10, 0]);
  assert.equal(mesh.triangles.length, 3);
  const pixels = new Uint32Array(reliefPixels(mesh).buffer);
  assert.equal(pixels[3], 0xffababab);
});

test("slopes use the neighbours that are valid; a slope towards the light is lighter", () => {
  const row = [0, 2, NaN];
  const z = (column: number, at: number): number => (at === 0 ? row[column] ?? NaN : NaN);
  assert.deepEqual(slopesAt(z, 1, 0, 0.5, 0.5), [4, 0]);
  assert.ok(shade(1, 0) > shade(0, 0));
  assert.ok(shade(-1, 0) < shade(0, 0));
  assert.ok(shade(0, -1) > shade(0, 1));
});

test("from above the image stands upright: right is right, its upper border is on top", () => {
  const matrix = matrixOf({ turn_deg: 0, tilt_deg: 90, zoom: 1 }, 100, 5, 3, 1);
  const at = (x: number, y: number, z: number): number[] =>
    [0, 1, 2].map((r) => Number((matrix[r]! * x + matrix[4 + r]! * y + matrix[8 + r]! * z + matrix[12 + r]!).toFixed(6)) + 0);
  assert.deepEqual(at(100, 0, 5).slice(0, 2), [1, 0]);
  assert.deepEqual(at(0, 100, 5).slice(0, 2), [0, 1]);
  assert.ok(at(0, 0, 10)[2]! < at(0, 0, 0)[2]!, "what is higher is nearer");
  // From the front heights go up on the screen, exaggerated.
  const front = matrixOf({ turn_deg: 0, tilt_deg: 0, zoom: 1 }, 100, 5, 3, 1);
  assert.ok(Math.abs(front[9]! * 10 + front[13]! - 0.15) < 1e-6);
});

test("looks stay within bounds, exaggerations are round", () => {
  assert.deepEqual(boundedLook({ turn_deg: 190, tilt_deg: 95, zoom: 0 }), { turn_deg: -170, tilt_deg: 90, zoom: 0.5 });
  assert.equal(suggestedExaggeration(10, 480), 5);
  assert.equal(suggestedExaggeration(1000, 480), 1);
  assert.equal(suggestedExaggeration(0, 480), 1);
});

test("a view rests soon after its last step, later where the steps come slowly", () => {
  assert.deepEqual([Infinity, 16, 50, 90, 400, 2000].map(restAfter_ms), [60, 60, 75, 135, 600, 60]);
});
