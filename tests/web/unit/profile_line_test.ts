import assert from "node:assert/strict";
import test from "node:test";
import { type ProfileLine, blocksOf, profileOf, sampleAt, samplesOf } from "../../../daemon/web/src/surface/profile_line.ts";

const map = { width: 100, height: 80, pitch_x: 0.5, pitch_y: 0.5 };
const plane = (column: number, row: number): number =>
  column < 0 || row < 0 || column >= map.width || row >= map.height ? NaN : 2 * (column + 0.5) * 0.5 + 3 * (row + 0.5) * 0.5;

function taken(line: ProfileLine, heights = plane) {
  const samples = samplesOf(map, line);
  assert.ok(typeof samples !== "string", String(samples));
  return profileOf(map, samples, heights, () => 0.1);
}

test("along a row the points are the file's", () => {
  const profile = taken({ from: { x: 0, y: 10.25 }, to: { x: 50, y: 10.25 }, width_um: 0 });
  assert.equal(profile.distance_um.length, 100);
  assert.equal(profile.distance_um[0], 0.25);
  profile.height_um.forEach((z, i) => assert.equal(z, plane(i, 20)));
});

test("a plane is a straight line in any direction, over any band", () => {
  for (const width_um of [0, 4]) {
    const line = { from: { x: 5, y: 7 }, to: { x: 41.3, y: 29.9 }, width_um };
    const profile = taken(line);
    const length = Math.hypot(36.3, 22.9);
    profile.distance_um.forEach((along, i) => {
      const x = 5 + (along / length) * 36.3;
      const y = 7 + (along / length) * 22.9;
      assert.ok(Math.abs((profile.height_um[i] ?? NaN) - (2 * x + 3 * y)) < 1e-9);
    });
  }
});

test("a hole is never filled: any missing neighbour, any hole across the band", () => {
  const holed = (column: number, row: number): number => (column === 40 && row === 30 ? NaN : plane(column, row));
  const near = sampleAt(map, holed, { x: 20.2, y: 15.2 });  // between (39, 29) and (40, 30)
  assert.ok(Number.isNaN(near));
  assert.equal(sampleAt(map, holed, { x: 19.75, y: 15.25 }), plane(39, 30));  // on a point beside it
  const row = taken({ from: { x: 0, y: 14.25 }, to: { x: 50, y: 14.25 }, width_um: 3 }, holed);
  assert.equal(row.height_um[40], null);
  assert.equal(row.sigma_um[40], null);
  assert.notEqual(row.height_um[42], null);
});

test("lines that cannot be taken say why", () => {
  const inside = { x: 10, y: 10 };
  assert.equal(samplesOf(map, { from: inside, to: { x: 51, y: 10 }, width_um: 0 }), "outside");
  assert.equal(samplesOf(map, { from: { x: 0, y: 1 }, to: { x: 50, y: 1 }, width_um: 3 }), "outside");
  assert.equal(samplesOf(map, { from: inside, to: { x: 10.4, y: 10 }, width_um: 0 }), "short");
  assert.equal(samplesOf(map, { from: inside, to: inside, width_um: 0 }), "short");
  assert.equal(samplesOf(map, { from: inside, to: { x: NaN, y: 0 }, width_um: 0 }), "number");
  assert.equal(samplesOf(map, { from: inside, to: { x: 20, y: 10 }, width_um: -1 }), "number");
});

test("the blocks hold every point that a sample asks for", () => {
  const samples = samplesOf(map, { from: { x: 3, y: 39 }, to: { x: 47, y: 2 }, width_um: 1.5 });
  assert.ok(typeof samples !== "string");
  const side = 16;
  const known = new Set(blocksOf(map, samples, side).map(({ column, row }) => `${column} ${row}`));
  profileOf(map, samples, (column, row) => {
    assert.ok(known.has(`${Math.floor(column / side) * side} ${Math.floor(row / side) * side}`), `${column} ${row}`);
    return 0;
  }, () => 0);
});
