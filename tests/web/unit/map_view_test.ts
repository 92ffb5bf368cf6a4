import assert from "node:assert/strict";
import test from "node:test";
import { clampView, fitView, middleOf, onCanvas, pointAt, toMap, toScreen, wantedTile, zoomAt } from "../../../daemon/web/src/surface/map_view.ts";

const map = { width: 5000, height: 4000, pitch_x: 0.5, pitch_y: 0.5 };
const canvas = { width: 1000, height: 500 };

test("the whole fits, and stands upright: y grows downwards", () => {
  const view = fitView(map, canvas);
  assert.deepEqual(view, { x: 1250, y: 1000, scale: 0.25 });
  assert.deepEqual(toScreen(view, canvas, { x: 1250, y: 0 }), { x: 500, y: 0 });
  assert.deepEqual(toMap(view, canvas, { x: 500, y: 500 }), { x: 1250, y: 2000 });
});

test("the place under the pointer stays under it", () => {
  const view = fitView(map, canvas);
  const at = { x: 700, y: 100 };
  const before = toMap(view, canvas, at);
  const after = toMap(zoomAt(view, canvas, at, 3, map), canvas, at);
  assert.ok(Math.hypot(before.x - after.x, before.y - after.y) < 1e-9);
});

test("a place of the window is found on a canvas that is shown a little larger, at any fraction of a pixel", () => {
  const shown = { left: 26.25, top: -40.5, width: 1002.5, height: 501.25 };
  assert.deepEqual(onCanvas(canvas, shown, { x: 26.25, y: -40.5 }), { x: 0, y: 0 });
  assert.deepEqual(onCanvas(canvas, shown, { x: 1028.75, y: 460.75 }), { x: 1000, y: 500 });
  assert.deepEqual(onCanvas(canvas, { left: 10, top: 20, width: 1000, height: 500 }, { x: 35, y: 47 }), { x: 25, y: 27 });
});

test("bounds: half of the whole, points of 64 pixels, and small maps may be larger than that", () => {
  const view = fitView(map, canvas);
  assert.equal(clampView({ ...view, scale: 1e-9 }, map, canvas).scale, 0.125);
  assert.equal(clampView({ ...view, scale: 1e9 }, map, canvas).scale, 128);
  assert.deepEqual([clampView({ ...view, x: -5, y: 1e9 }, map, canvas)].map(({ x, y }) => [x, y]), [[0, 2000]]);
  const small = { width: 16, height: 16, pitch_x: 1, pitch_y: 1 };
  const whole = fitView(small, { width: 2000, height: 2000 });
  assert.deepEqual(clampView(whole, small, { width: 2000, height: 2000 }), whole);
});

test("points are found by their corners, and told by their middles", () => {
  assert.deepEqual(pointAt(map, { x: 0, y: 0 }), { column: 0, row: 0 });
  assert.deepEqual(pointAt(map, { x: 2499.9, y: 1999.9 }), { column: 4999, row: 3999 });
  assert.equal(pointAt(map, { x: 2500, y: 0 }), null);
  assert.equal(pointAt(map, { x: -0.1, y: 0 }), null);
  assert.deepEqual(middleOf(map, { column: 2, row: 0 }), { x: 1.25, y: 0.25 });
});

test("what is fetched covers what is seen, and is never finer than the screen needs by more than a step", () => {
  for (const scale of [0.125, 0.25, 0.7, 1.9, 2, 30]) {
    for (const x of [0, 333, 2500]) {
      const view = { x, y: 700, scale };
      const wanted = wantedTile(view, canvas, map, 1);
      assert.ok(wanted);
      const { window, most, factor } = wanted;
      const seen_left = Math.max(0, toMap(view, canvas, { x: 0, y: 0 }).x / map.pitch_x);
      const seen_right = Math.min(map.width, toMap(view, canvas, { x: canvas.width, y: 0 }).x / map.pitch_x);
      assert.ok(window.x <= seen_left && window.x + window.w >= seen_right, JSON.stringify(wanted));
      assert.ok(window.x >= 0 && window.y >= 0 && window.x + window.w <= map.width && window.y + window.h <= map.height);
      assert.ok(factor * scale * 0.5 <= 1 || factor === 1, `factor ${factor} at ${scale}`);
      assert.ok(Math.ceil(Math.max(window.w, window.h) / most) <= factor);
    }
  }
  assert.equal(wantedTile({ x: 1e6, y: 0, scale: 1 }, canvas, map, 1), null);
});
