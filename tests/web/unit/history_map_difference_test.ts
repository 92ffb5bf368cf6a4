import assert from "node:assert/strict";
import test from "node:test";
import { differenceOf, extremes, whyNotComparable } from "../../../daemon/web/src/history/map_difference.ts";

const make = (width: number, height: number, of: (x: number, y: number) => number): Float32Array =>
  Float32Array.from({ length: width * height }, (_, i) => of(i % width, Math.floor(i / width)));

test("an offset and a tilt are no difference; a bump is", () => {
  const bump = (x: number, y: number): number => (x === 20 && y === 10 ? 1e-6 : 0);
  const a = make(64, 48, (x, y) => 1e-6 * Math.sin(x / 5) + 1e-6 * Math.cos(y / 7));
  const b = make(64, 48, (x, y) => 1e-6 * Math.sin(x / 5) + 1e-6 * Math.cos(y / 7) + 5e-6 + 1e-8 * x - 2e-8 * y + bump(x, y));
  const found = differenceOf(a, b, 64) ?? assert.fail();
  assert.ok(Math.abs(found.slope_x - 1e-8) < 5e-11 && Math.abs(found.slope_y + 2e-8) < 5e-11);
  assert.ok(Math.abs(found.offset - (5e-6 + 1e-8 * 31.5 - 2e-8 * 23.5)) < 1e-9);
  assert.ok(Math.abs(found.greatest - 1e-6) < 2e-9 && found.least > -3e-9);
  assert.equal(found.points, 64 * 48);
});

test("holes of either map are holes of the difference and count for nothing", () => {
  const a = make(8, 8, (x) => (x === 0 ? NaN : 0));
  const b = make(8, 8, (_, y) => (y === 0 ? NaN : 1));
  const found = differenceOf(a, b, 8) ?? assert.fail();
  assert.equal(found.points, 49);
  assert.ok(Number.isNaN(found.values[0]) && Number.isNaN(found.values[8]) && Number.isNaN(found.values[1]));
  assert.ok(Math.abs(found.values[9] ?? NaN) < 1e-12 && found.rms < 1e-12);
});

test("no plane lies through two points, or through points on a line", () => {
  const only = (of: (x: number, y: number) => boolean) => make(6, 6, (x, y) => (of(x, y) ? 1 : NaN));
  const flat = make(6, 6, () => 0);
  assert.equal(differenceOf(flat, only(() => false), 6), null);
  assert.equal(differenceOf(flat, only((x, y) => y === 0 && x < 2), 6), null);
  assert.equal(differenceOf(flat, only((_, y) => y === 3), 6), null);
  assert.equal(differenceOf(flat, only((x, y) => x === y), 6), null);
  assert.notEqual(differenceOf(flat, only((x, y) => y === 0 || x === 0), 6), null);
});

test("maps of other sizes or pitches are refused", () => {
  const map = { width: 1000, height: 800, pitch_x_um: 1, pitch_y_um: 1 };
  assert.equal(whyNotComparable(map, map), null);
  assert.equal(whyNotComparable(map, { ...map, width: 999 }), "size");
  assert.equal(whyNotComparable(map, { ...map, pitch_y_um: 1.001 }), "pitch");
  assert.equal(whyNotComparable(map, { ...map, pitch_x_um: 1 + 1e-9 }), null);
});

test("a spike is seen however small the picture", () => {
  const values = make(100, 50, (x, y) => (x === 77 && y === 33 ? -9 : x === 99 ? NaN : 1));
  const small = extremes(values, 100, 10);
  assert.deepEqual([small.width, small.height, small.factor], [10, 5, 10]);
  assert.equal(small.values[3 * 10 + 7], -9);
  assert.equal(small.values[0], 1);
  assert.equal(extremes(values, 100, 100).factor, 1);
});
