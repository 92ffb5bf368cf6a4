// What of a recipe can be drawn into a map, and what dragging it changes in the document. Lengths in um from the map's upper left corner.
import { type Path, getAt } from "./document.ts";
import { type Json, isObject } from "./schema.ts";

export interface Point {
  x: number;
  y: number;
}

export interface Drawn {
  path: Path;          // of what holds its numbers
  name: string;
  kind: "rectangle" | "circle" | "polygon" | "line";
  handles: Point[];    // rectangle: two opposite corners; circle: centre and a point of the rim; else the corners
  width_um: number;    // of a line: the band across it
}

export interface Edit {
  path: Path;
  value: Json;
}

const numbers = (value: Json | undefined, keys: readonly string[]): number[] | null => {
  if (!isObject(value)) return null;
  const found = keys.map((key) => value[key]);
  return found.every((each): each is number => typeof each === "number") ? found : null;
};

const pointOf = (value: Json | undefined): Point | null =>
  Array.isArray(value) && value.length === 2 && typeof value[0] === "number" && typeof value[1] === "number" ? { x: value[0], y: value[1] } : null;

function regionOf(path: Path, name: string, value: Json): Drawn | null {
  if (!isObject(value)) return null;
  const rectangle = numbers(value["rectangle_um"], ["x", "y", "width", "height"]);
  if (rectangle) {
    const [x = 0, y = 0, width = 0, height = 0] = rectangle;
    return { path: [...path, "rectangle_um"], name, kind: "rectangle", handles: [{ x, y }, { x: x + width, y: y + height }], width_um: 0 };
  }
  const circle = numbers(value["circle_um"], ["x", "y", "radius"]);
  if (circle) {
    const [x = 0, y = 0, radius = 0] = circle;
    return { path: [...path, "circle_um"], name, kind: "circle", handles: [{ x, y }, { x: x + radius, y }], width_um: 0 };
  }
  const polygon = value["polygon_um"];
  if (!Array.isArray(polygon)) return null;
  const handles = polygon.map(pointOf).filter((point): point is Point => point !== null);
  return handles.length === polygon.length && handles.length >= 2 ? { path: [...path, "polygon_um"], name, kind: "polygon", handles, width_um: 0 } : null;
}

export function drawingsOf(document: Json): Drawn[] {
  const found: Drawn[] = [];
  const regions = getAt(document, ["evaluation", "regions"]);
  for (const [name, value] of Object.entries(isObject(regions) ? regions : {})) {
    const region = regionOf(["evaluation", "regions", name], name, value);
    if (region) found.push(region);
  }
  const measurements = getAt(document, ["evaluation", "measurements"]);
  for (const [name, value] of Object.entries(isObject(measurements) ? measurements : {})) {
    if (!isObject(value) || value["kind"] !== "profile") continue;
    const [from, to] = [pointOf(value["from_um"]), pointOf(value["to_um"])];
    const width = value["band_width_um"];
    if (from && to) found.push({ path: ["evaluation", "measurements", name], name, kind: "line", handles: [from, to], width_um: typeof width === "number" ? width : 0 });
  }
  return found;
}

// A hundredth of a micrometre is finer than any pixel.
const round = (value: number): number => Math.round(value * 100) / 100;

function editsOf(shape: Drawn, handles: readonly Point[]): Edit[] {
  const [a = { x: 0, y: 0 }, b = { x: 0, y: 0 }] = handles;
  switch (shape.kind) {
    case "rectangle":
      return [{
        path: shape.path,
        value: { x: round(Math.min(a.x, b.x)), y: round(Math.min(a.y, b.y)), width: round(Math.max(0.01, Math.abs(b.x - a.x))), height: round(Math.max(0.01, Math.abs(b.y - a.y))) },
      }];
    case "circle":
      return [{ path: shape.path, value: { x: round(a.x), y: round(a.y), radius: round(Math.max(0.01, Math.hypot(b.x - a.x, b.y - a.y))) } }];
    case "polygon":
      return [{ path: shape.path, value: handles.map((point) => [round(point.x), round(point.y)]) }];
    case "line":
      return [{ path: [...shape.path, "from_um"], value: [round(a.x), round(a.y)] }, { path: [...shape.path, "to_um"], value: [round(b.x), round(b.y)] }];
  }
}

export const moved = (shape: Drawn, dx: number, dy: number): Edit[] =>
  editsOf(shape, shape.handles.map((point) => ({ x: point.x + dx, y: point.y + dy })));

export function dragged(shape: Drawn, handle: number, to: Point): Edit[] {
  const [centre] = shape.handles;
  // A circle goes with its centre.
  if (shape.kind === "circle" && handle === 0 && centre) return moved(shape, to.x - centre.x, to.y - centre.y);
  return editsOf(shape, shape.handles.map((point, i) => (i === handle ? to : point)));
}

// A shape of two handles, from one place to another: also where the drag goes back over its beginning.
export const spanned = (shape: Drawn, from: Point, to: Point): Edit[] => editsOf(shape, [from, to]);

// A rectangle that is drawn from a place in a map of this size, wherever the pointer went.
export function rectangleBetween(from: Point, to: Point, size_um: Point): Json {
  const within = (point: Point): Point => ({ x: Math.min(size_um.x, Math.max(0, point.x)), y: Math.min(size_um.y, Math.max(0, point.y)) });
  const [edit] = editsOf({ path: [], name: "", kind: "rectangle", handles: [], width_um: 0 }, [within(from), within(to)]);
  return edit?.value ?? null;
}

// The handle within reach of a point; -1 where there is none.
export function handleAt(shape: Drawn, at: Point, reach: number): number {
  const far = shape.handles.map((point) => Math.hypot(point.x - at.x, point.y - at.y));
  const nearest = far.indexOf(Math.min(...far));
  return (far[nearest] ?? Infinity) <= reach ? nearest : -1;
}

const inPolygon = (corners: readonly Point[], at: Point): boolean => {
  let inside = false;
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length] as Point;
    if ((a.y > at.y) !== (b.y > at.y) && at.x < a.x + ((b.x - a.x) * (at.y - a.y)) / (b.y - a.y)) inside = !inside;
  });
  return inside;
};

export function contains(shape: Drawn, at: Point, reach: number): boolean {
  const [a = { x: 0, y: 0 }, b = { x: 0, y: 0 }] = shape.handles;
  switch (shape.kind) {
    case "rectangle": return at.x >= Math.min(a.x, b.x) && at.x <= Math.max(a.x, b.x) && at.y >= Math.min(a.y, b.y) && at.y <= Math.max(a.y, b.y);
    case "circle": return Math.hypot(at.x - a.x, at.y - a.y) <= Math.hypot(b.x - a.x, b.y - a.y);
    case "polygon": return inPolygon(shape.handles, at);
    case "line": {
      const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
      const along = ((at.x - a.x) * (b.x - a.x) + (at.y - a.y) * (b.y - a.y)) / length;
      const across = Math.abs((at.x - a.x) * (b.y - a.y) - (at.y - a.y) * (b.x - a.x)) / length;
      return along >= 0 && along <= length && across <= Math.max(reach, shape.width_um / 2);
    }
  }
}

// A new shape in the middle of a map.
export function newShape(kind: Drawn["kind"], width_um: number, height_um: number): Json {
  const [w, h] = [width_um, height_um].map((side) => round(side / 4)) as [number, number];
  const [x, y] = [round((width_um - w) / 2), round((height_um - h) / 2)];
  switch (kind) {
    case "rectangle": return { rectangle_um: { x, y, width: w, height: h } };
    case "circle": return { circle_um: { x: round(width_um / 2), y: round(height_um / 2), radius: round(Math.min(w, h) / 2) } };
    case "polygon": return { polygon_um: [[x, y], [round(x + w), y], [round(x + w / 2), round(y + h)]] };
    case "line": return { kind: "profile", from_um: [x, round(height_um / 2)], to_um: [round(x + w), round(height_um / 2)], parameters: ["Ra", "Rz"] };
  }
}
