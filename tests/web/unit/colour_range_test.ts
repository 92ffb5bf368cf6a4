import assert from "node:assert/strict";
import test from "node:test";
import { kGreyTable, kViridisTable, level, rgba } from "../../../daemon/web/src/surface/colours.ts";
import { percentileRange, wholeRange } from "../../../daemon/web/src/surface/colour_range.ts";
import { paintReasons, paintValues } from "../../../daemon/web/src/surface/paint.ts";
import { kHoleReasons, mainReason, reasonsOf } from "../../../daemon/web/src/surface/hole_reasons.ts";

test("percentiles go by the nearest rank and leave holes out", () => {
  const values = Float32Array.from({ length: 200 }, (_, i) => (i % 2 ? NaN : i / 2));  // 0 .. 99 and as many holes
  assert.deepEqual(percentileRange(values, 0, 1), { low: 0, high: 99 });
  assert.deepEqual(percentileRange(values, 0.05, 0.95), { low: 4, high: 94 });
  assert.deepEqual(percentileRange(new Float32Array([3]), 0.005, 0.995), { low: 3, high: 3 });
  assert.equal(percentileRange(new Float32Array([NaN, NaN]), 0, 1), null);
  assert.deepEqual(percentileRange(new Float32Array([-10, 9, 100]), 0, 1), { low: -10, high: 100 });  // by value, not as text
});

test("the whole range is that of the extremes of blocks", () => {
  assert.deepEqual(wholeRange(new Float32Array([1, NaN, -4]), new Float32Array([2, NaN, 50])), { low: -4, high: 50 });
  assert.equal(wholeRange(new Float32Array([NaN]), new Float32Array([NaN])), null);
});

test("values find their colours; a range without width has the middle", () => {
  assert.equal(level(5, { low: 0, high: 10 }), 128);
  assert.equal(level(-1, { low: 0, high: 10 }), 0);
  assert.equal(level(11, { low: 0, high: 10 }), 255);
  assert.equal(level(3, { low: 3, high: 3 }), 128);
  assert.deepEqual([kViridisTable[0], kViridisTable[255], kGreyTable[128]], [0x440154, 0xfde725, 0x808080]);
  assert.deepEqual([...new Uint8Array(new Uint32Array([rgba(0x112233)]).buffer)], [0x11, 0x22, 0x33, 0xff]);
});

test("holes are grey, reasons have the colour of what says most", () => {
  const pixels = new Uint32Array(2);
  paintValues(new Float32Array([NaN, 1]), { low: 0, high: 1 }, kGreyTable, pixels);
  assert.deepEqual([...pixels], [rgba(0xababab), rgba(0xffffff)]);
  assert.equal(mainReason(1024 + 16)?.name, "saturated");
  assert.deepEqual(reasonsOf(1 + 4).map(({ name }) => name), ["last_slice", "low_prominence"]);
  assert.deepEqual(reasonsOf(0), []);
  assert.equal(mainReason(8192)?.name, "unknown");
  paintReasons(new Float32Array([0, 1024]), pixels);
  assert.equal(pixels[1], rgba(0xffd21e));
  assert.equal(new Set(kHoleReasons.map(({ colour }) => colour)).size, kHoleReasons.length);
});
