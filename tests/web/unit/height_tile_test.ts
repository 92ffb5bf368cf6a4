import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";

const { parseTile, tileAddress } = await import("../../../daemon/web/src/surface/height_tile.ts");

function reply(words: number[], values: number[], magic = "FVDH"): ArrayBuffer {
  const bytes = new ArrayBuffer(32 + 4 * values.length);
  const view = new DataView(bytes);
  [...magic].forEach((letter, i) => view.setUint8(i, letter.charCodeAt(0)));
  words.forEach((word, i) => view.setUint32(4 + 4 * i, word, true));
  values.forEach((value, i) => view.setFloat32(32 + 4 * i, value, true));
  return bytes;
}

test("an address has the window, and the version of what browsers keep for ever", () => {
  assert.equal(tileAddress("J 7/x", "sigma", null, 512), "/api/v1/jobs/J%207%2Fx/height?kind=sigma&max=512&v=1");
  assert.equal(tileAddress("J7", "height", { x: 1, y: 2, w: 3, h: 4 }, 64), "/api/v1/jobs/J7/height?kind=height&max=64&v=1&x=1&y=2&w=3&h=4");
});

test("one plane serves as mean, lowest and highest", () => {
  const tile = parseTile(reply([1, 2, 1, 1, 1, 7, 5], [1.5, NaN]), "height", { x: 3, y: 4 });
  assert.deepEqual([...tile.mean], [1.5, NaN]);
  assert.equal(tile.lowest, tile.mean);
  assert.deepEqual(tile.window, { x: 3, y: 4, w: 2, h: 1 });
  assert.equal(tile.map_width, 7);
});

test("three planes are mean, lowest, highest; the window ends with the map", () => {
  const tile = parseTile(reply([1, 2, 1, 4, 3, 7, 3], [1, 2, 3, 4, 5, 6]), "height");
  assert.deepEqual([[...tile.mean], [...tile.lowest], [...tile.highest]], [[1, 2], [3, 4], [5, 6]]);
  assert.deepEqual(tile.window, { x: 0, y: 0, w: 7, h: 3 });
});

test("what is cut, of another version or no map at all is refused", () => {
  assert.throws(() => parseTile(reply([1, 2, 2, 1, 1, 2, 2], [1, 2, 3]), "height"), /incomplete/);
  assert.throws(() => parseTile(reply([2, 1, 1, 1, 1, 1, 1], [1]), "height"), /version 2/);
  assert.throws(() => parseTile(reply([1, 1, 1, 1, 2, 1, 1], [1, 1]), "height"), /incomplete/);
  assert.throws(() => parseTile(reply([1, 1, 1, 0, 1, 1, 1], [1]), "height"), /incomplete/);
  assert.throws(() => parseTile(reply([1, 1, 1, 1, 1, 1, 1], [1], "<htm"), "height"), /no map/);
  assert.throws(() => parseTile(new ArrayBuffer(5), "height"), /no map/);
});
