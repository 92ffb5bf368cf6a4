import assert from "node:assert/strict";
import test from "node:test";
import { type CurvePoint, readCurve, suggestScan, suggestWindow } from "../../../daemon/web/src/recipe/suggest.ts";

const bell = (z: number, centre: number, sigma: number): number => Math.exp(-((z - centre) ** 2) / (2 * sigma * sigma));
const curve = (of: (z: number) => number, from = 0, to = 200, step = 5): CurvePoint[] =>
  Array.from({ length: (to - from) / step + 1 }, (_, i) => [from + i * step, of(from + i * step)]);

test("width and place of a peak over its ground", () => {
  const found = readCurve(curve((z) => 6 + 24 * bell(z, 100, 12))) ?? assert.fail();
  assert.equal(found.peak_um, 100);
  assert.ok(Math.abs(found.width_um - 2.3548 * 12) < 0.6, String(found.width_um));
});

test("a second height in the picture belongs to the range", () => {
  const found = readCurve(curve((z) => 6 + 24 * bell(z, 140, 10) + 10 * bell(z, 50, 10))) ?? assert.fail();
  assert.ok(found.first_um <= 45 && found.last_um >= 150);
  const scan = suggestScan(found);
  assert.ok(scan.start_um <= 45 - found.width_um && scan.start_um + scan.step_um * (scan.slices - 1) >= 150 + found.width_um);
});

test("what is no peak gives no advice", () => {
  assert.equal(readCurve([]), null);
  assert.equal(readCurve(curve(() => 6)), null);
  assert.equal(readCurve(curve((z) => 6 + 0.01 * (z % 2))), null);
  assert.equal(readCurve(curve((z) => z + 1)), null);
  assert.equal(readCurve(curve((z) => 6 + 24 * bell(z, 0, 20))), null);
});

test("the order of looks does not matter", () => {
  const points = curve((z) => 6 + 24 * bell(z, 100, 12));
  assert.deepEqual(readCurve([...points].reverse()), readCurve(points));
});

test("a scan has enough slices, and not without end", () => {
  const found = readCurve(curve((z) => 6 + 24 * bell(z, 100, 12))) ?? assert.fail();
  assert.equal(suggestScan(found).step_um, 5);
  assert.ok(suggestScan({ ...found, width_um: 0.01 }).slices <= 2000);
});

test("the window grows where points are missing, and stays odd", () => {
  assert.equal(suggestWindow(0.95, 9), 9);
  assert.equal(suggestWindow(0.5, 9), 13);
  assert.equal(suggestWindow(0.5, 31), 31);
});
