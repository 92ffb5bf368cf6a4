// What is drawn over pictures, and what the progress says.
import assert from "node:assert/strict";
import test from "node:test";
import { kFocusColour, kSaturatedColour, paintMarks } from "../../../daemon/web/src/run/focus_peaking.ts";
import { pitchOf, shapesOf } from "../../../daemon/web/src/run/regions.ts";
import { marked, plannedZ_um, secondsLeft } from "../../../daemon/web/src/run/time_left.ts";

function picture(rows: number[][]): { rgba: Uint8ClampedArray; width: number; height: number } {
  const flat = rows.flat();
  const rgba = new Uint8ClampedArray(flat.length * 4);
  flat.forEach((grey, i) => rgba.set([grey, grey, grey, 255], 4 * i));
  return { rgba, width: rows[0]?.length ?? 0, height: rows.length };
}
const pixel = (rgba: Uint8ClampedArray, i: number): number[] => [...rgba.slice(4 * i, 4 * i + 3)];

test("a sharp point is marked, a ramp and the border are not", () => {
  const sharp = picture([[90, 90, 90, 90], [90, 90, 200, 90], [90, 90, 90, 90]]);
  paintMarks(sharp.rgba, sharp.width, sharp.height, { focus: true, saturation: true });
  assert.deepEqual(pixel(sharp.rgba, 6), [...kFocusColour]);
  assert.deepEqual(pixel(sharp.rgba, 7), [90, 90, 90]);
  const ramp = picture([[10, 60, 110, 160], [10, 60, 110, 160], [10, 60, 110, 160]]);
  const before = [...ramp.rgba];
  paintMarks(ramp.rgba, ramp.width, ramp.height, { focus: true, saturation: true });
  assert.deepEqual([...ramp.rgba], before);
});

test("a mark does not change what its neighbours are judged by", () => {
  const { rgba, width, height } = picture([[90, 90, 90, 90, 90], [90, 200, 90, 200, 90], [90, 90, 90, 90, 90]]);
  paintMarks(rgba, width, height, { focus: true, saturation: false });
  assert.deepEqual([6, 7, 8].map((i) => pixel(rgba, i)), [[...kFocusColour], [...kFocusColour], [...kFocusColour]]);
});

test("too bright goes before sharp, and each can be left out", () => {
  const rows = [[0, 0, 0], [0, 255, 0], [0, 0, 0]];
  const both = picture(rows);
  paintMarks(both.rgba, 3, 3, { focus: true, saturation: true });
  assert.deepEqual(pixel(both.rgba, 4), [...kSaturatedColour]);
  const focus = picture(rows);
  paintMarks(focus.rgba, 3, 3, { focus: true, saturation: false });
  assert.deepEqual(pixel(focus.rgba, 4), [...kFocusColour]);
  const none = picture(rows);
  paintMarks(none.rgba, 3, 3, { focus: false, saturation: false });
  assert.deepEqual(pixel(none.rgba, 4), [255, 255, 255]);
});

test("regions and profiles of a recipe become shapes, the others are named", () => {
  const { shapes, notDrawn } = shapesOf({
    evaluation: {
      regions: {
        box: { rectangle_um: { x: 1, y: 2, width: 3, height: 4 } },
        ring: { circle_um: { x: 5, y: 6, radius: 7 } },
        field: { polygon_um: [[0, 0], [1, 0], [0, 1]] },
        mask: { mask_png: "a.png" },
        rest: { not: "box" },
        broken: { rectangle_um: { x: 1, y: "2" } },
        line: { polygon_um: [[0, 0], [1, 1]] },
      },
      measurements: { rough: { kind: "profile", from_um: [0, 1], to_um: [2, 3] }, step: { kind: "step_height" } },
    },
  });
  assert.deepEqual(shapes, [
    { name: "box", kind: "rectangle", x: 1, y: 2, width: 3, height: 4 },
    { name: "ring", kind: "circle", x: 5, y: 6, radius: 7 },
    { name: "field", kind: "polygon", points: [[0, 0], [1, 0], [0, 1]] },
    { name: "rough", kind: "line", points: [[0, 1], [2, 3]] },
  ]);
  assert.deepEqual(notDrawn, ["mask", "rest", "broken", "line"]);
});

test("what is no recipe has no shapes and no pitch", () => {
  for (const nothing of [null, undefined, 3, "x", {}, { evaluation: [] }, { evaluation: { regions: null, measurements: { a: null } } }]) {
    assert.deepEqual(shapesOf(nothing), { shapes: [], notDrawn: [] });
    assert.equal(pitchOf(nothing), null);
  }
  assert.deepEqual(pitchOf({ reconstruct: { lateral: { pixel_pitch_x_um: 0.5, pixel_pitch_y_um: 0.6 } } }), { x: 0.5, y: 0.6 });
});

test("seconds left follow from the slices' pace", () => {
  const marks = [{ at_ms: 0, slices: 0 }, { at_ms: 900, slices: 1 }, { at_ms: 1000, slices: 2 }, { at_ms: 1100, slices: 3 }];
  assert.equal(secondsLeft(marks, 13), 1);
  assert.equal(secondsLeft(marks, 3), 0);
  assert.equal(secondsLeft(marks, 2), 0, "slices that were taken again may be more than planned");
  assert.equal(secondsLeft(marks.slice(0, 3), 13), null, "one interval tells no pace");
  assert.equal(secondsLeft([], 13), null);
});

test("the same slice is marked once", () => {
  const one = marked([], 5, 1);
  assert.equal(marked(one, 9, 1), one);
  assert.deepEqual(marked(one, 9, 2), [{ at_ms: 5, slices: 1 }, { at_ms: 9, slices: 2 }]);
});

test("z as the recipe plans it", () => {
  const scan = { start_um: -7, step_um: 10, slices: 21 };
  assert.equal(plannedZ_um(scan, 1), -7);
  assert.equal(plannedZ_um(scan, 21), 193);
  assert.equal(plannedZ_um(scan, 22), -7, "the second scan of a job");
  assert.equal(plannedZ_um({ ...scan, direction: "down" }, 1), 193);
  assert.equal(plannedZ_um(scan, 0), null);
  assert.equal(plannedZ_um({ start_um: 0 }, 3), null);
  assert.equal(plannedZ_um(null, 3), null);
});
