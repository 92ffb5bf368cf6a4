import assert from "node:assert/strict";
import test from "node:test";
import { between, fitCircle, fitLine, fittedAt, nearest, partOf } from "../../../daemon/web/src/surface/profile_fits.ts";

const near = (a: number | null | undefined, b: number, by = 1e-9): void =>
  assert.ok(Math.abs((a ?? NaN) - b) <= by, `${a} is not ${b}`);

test("a line through points on it, and through points beside it", () => {
  const x = [0, 1, 2, 3];
  const exact = fitLine({ x, y: x.map((value) => 120 + 0.5 * value) });
  near(exact?.slope, 0.5);
  near(exact?.at_zero, 120);
  near(exact?.rms, 0);
  near(exact?.angle_deg, (Math.atan(0.5) * 180) / Math.PI);
  const rough = fitLine({ x, y: [1, -1, -1, 1] });
  near(rough?.slope, 0);
  near(rough?.rms, 1);
  assert.equal(fitLine({ x: [1], y: [1] }), null);
  assert.equal(fitLine({ x: [2, 2], y: [1, 5] }), null);
});

test("a circle through a short arc of it, far from the origin", () => {
  for (const top of [1, -1]) {
    const angles = Array.from({ length: 40 }, (_, i) => Math.PI / 2 - 0.4 + i * 0.02);
    const arc = { x: angles.map((a) => 5000 + 10 * Math.cos(a)), y: angles.map((a) => 250 + top * 10 * Math.sin(a)) };
    const fit = fitCircle(arc);
    near(fit?.radius, 10, 1e-6);
    near(fit?.x, 5000, 1e-6);
    near(fit?.y, 250, 1e-6);
    assert.equal(fit?.convex, top > 0);
    near(fit?.rms, 0, 1e-8);
    near(fittedAt(fit!, 5000), 250 + top * 10, 1e-6);
    assert.equal(fittedAt(fit!, 5011), null);
  }
});

test("the circle is the one of the least distances, not of the algebraic ones", () => {
  const angles = Array.from({ length: 60 }, (_, i) => 0.6 + i * 0.033);
  const noise = (i: number): number => 0.3 * Math.sin(12.9898 * i * i);
  const points = { x: angles.map((a, i) => (10 + noise(i)) * Math.cos(a)), y: angles.map((a, i) => (10 + noise(i)) * Math.sin(a)) };
  const fit = fitCircle(points);
  assert.ok(fit);
  const cost = (x: number, y: number, r: number): number =>
    points.x.reduce((sum, px, i) => sum + (Math.hypot(px - x, points.y[i]! - y) - r) ** 2, 0);
  const best = cost(fit.x, fit.y, fit.radius);
  for (const [dx, dy, dr] of [[1e-3, 0, 0], [-1e-3, 0, 0], [0, 1e-3, 0], [0, -1e-3, 0], [0, 0, 1e-3], [0, 0, -1e-3], [1e-3, 1e-3, -1e-3]] as const) {
    assert.ok(cost(fit.x + dx, fit.y + dy, fit.radius + dr) > best);
  }
  near(fit.radius, 10, 0.2);
});

test("no circle through fewer than three points or a straight line", () => {
  assert.equal(fitCircle({ x: [0, 1], y: [0, 1] }), null);
  assert.equal(fitCircle({ x: [0, 1, 2, 3], y: [5, 6, 7, 8] }), null);
  assert.equal(fitCircle({ x: [1, 1, 1], y: [1, 1, 1] }), null);
});

test("a part leaves holes out and takes its ends in either order", () => {
  assert.deepEqual(partOf([1, 2, 3, 4], [10, null, 30, 40], 3, 1), { x: [1, 3], y: [10, 30] });
  assert.deepEqual(partOf([], [], 0, 1), { x: [], y: [] });
});

test("two cursors: difference, angle, length; the nearest point may be a hole", () => {
  const step = between({ x: 10, z: 5 }, { x: 13, z: 1 });
  near(step.dx, 3);
  near(step.dz, -4);
  near(step.length, 5);
  near(step.angle_deg, (Math.atan2(-4, 3) * 180) / Math.PI);
  assert.deepEqual(nearest([0.5, 1.5, 2.5], [1, null, 3], 1.9), { index: 1, x: 1.5, z: null });
  assert.equal(nearest([], [], 1), null);
});
