import assert from "node:assert/strict";
import test from "node:test";
import { setAt } from "../../../daemon/web/src/recipe/document.ts";
import { contains, dragged, drawingsOf, handleAt, moved, newShape, rectangleBetween, spanned } from "../../../daemon/web/src/recipe/drawing.ts";
import type { Json } from "../../../daemon/web/src/recipe/schema.ts";

const document: Json = {
  evaluation: {
    regions: {
      land: { rectangle_um: { x: 10, y: 20, width: 100, height: 50 }, shrink_um: 2 },
      hole: { circle_um: { x: 50, y: 50, radius: 10 } },
      corner: { polygon_um: [[0, 0], [30, 0], [0, 30]] },
      rest: { not: "land" },
      broken: { rectangle_um: { x: "a", y: 0, width: 1, height: 1 } },
    },
    measurements: { line: { kind: "profile", from_um: [0, 0], to_um: [100, 0], band_width_um: 10, parameters: ["Ra"] }, step: { kind: "step_height" } },
  },
};
const shapes = drawingsOf(document);
const named = (name: string) => shapes.find((shape) => shape.name === name) ?? assert.fail(name);

test("what has numbers is drawn, in the document's order", () => {
  assert.deepEqual(shapes.map(({ name, kind }) => [name, kind]), [["land", "rectangle"], ["hole", "circle"], ["corner", "polygon"], ["line", "line"]]);
  assert.deepEqual(drawingsOf("no object"), []);
});

test("moving changes the place and nothing else", () => {
  const [edit] = moved(named("land"), 5, -3);
  assert.deepEqual(edit, { path: ["evaluation", "regions", "land", "rectangle_um"], value: { x: 15, y: 17, width: 100, height: 50 } });
  const after = setAt(document, edit?.path ?? [], edit?.value ?? null) as { evaluation: { regions: { land: { shrink_um: number } } } };
  assert.equal(after.evaluation.regions.land.shrink_um, 2);
  assert.deepEqual(moved(named("line"), 1, 2).map(({ value }) => value), [[1, 2], [101, 2]]);
});

test("a corner that is dragged across the other leaves a rectangle", () => {
  const [edit] = dragged(named("land"), 1, { x: 0, y: 0 });
  assert.deepEqual(edit?.value, { x: 0, y: 0, width: 10, height: 20 });
});

test("a circle goes with its centre and grows with its rim", () => {
  assert.deepEqual(dragged(named("hole"), 0, { x: 60, y: 50 })[0]?.value, { x: 60, y: 50, radius: 10 });
  assert.deepEqual(dragged(named("hole"), 1, { x: 50, y: 70 })[0]?.value, { x: 50, y: 50, radius: 20 });
});

test("what the pointer is on", () => {
  assert.equal(handleAt(named("land"), { x: 111, y: 69 }, 3), 1);
  assert.equal(handleAt(named("land"), { x: 60, y: 40 }, 3), -1);
  assert.ok(contains(named("corner"), { x: 5, y: 5 }, 1) && !contains(named("corner"), { x: 20, y: 20 }, 1));
  assert.ok(contains(named("line"), { x: 50, y: 4 }, 1) && !contains(named("line"), { x: 50, y: 6 }, 1) && !contains(named("line"), { x: 120, y: 0 }, 1));
});

test("new shapes lie inside the map", () => {
  assert.deepEqual(newShape("rectangle", 400, 200), { rectangle_um: { x: 150, y: 75, width: 100, height: 50 } });
  assert.deepEqual(newShape("circle", 400, 200), { circle_um: { x: 200, y: 100, radius: 25 } });
});

test("a rectangle is drawn in all directions, and stays in the map", () => {
  const size = { x: 200, y: 100 };
  assert.deepEqual(rectangleBetween({ x: 50, y: 60 }, { x: 20, y: 10 }, size), { x: 20, y: 10, width: 30, height: 50 });
  assert.deepEqual(rectangleBetween({ x: 150, y: 60 }, { x: 500, y: -10 }, size), { x: 150, y: 0, width: 50, height: 60 });
});

test("a corner that is dragged over the other one and back ends where the pointer is", () => {
  let now = setAt({}, ["evaluation", "regions", "a"], { rectangle_um: { x: 10, y: 10, width: 40, height: 40 } });
  const fixed = { x: 10, y: 10 };
  for (const to of [{ x: 20, y: 20 }, { x: 4, y: 2 }, { x: 60, y: 70 }]) {
    const [shape] = drawingsOf(now);
    for (const { path, value } of spanned(shape ?? assert.fail(), fixed, to)) now = setAt(now, path, value);
  }
  assert.deepEqual(now, { evaluation: { regions: { a: { rectangle_um: { x: 10, y: 10, width: 50, height: 60 } } } } });
});
