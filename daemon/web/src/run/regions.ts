// The recipe's regions and profiles as shapes in um, in the image's coordinates (y downwards).
export type Shape =
  | { name: string; kind: "rectangle"; x: number; y: number; width: number; height: number }
  | { name: string; kind: "circle"; x: number; y: number; radius: number }
  | { name: string; kind: "polygon"; points: [number, number][] }
  | { name: string; kind: "line"; points: [number, number][] };

export interface Drawn {
  shapes: Shape[];
  notDrawn: string[];  // names of regions that are told by a mask, heights or other regions
}

type Keys = Record<string, unknown>;
const keysOf = (value: unknown): Keys => (typeof value === "object" && value !== null ? (value as Keys) : {});
const isPoint = (value: unknown): value is [number, number] =>
  Array.isArray(value) && value.length === 2 && value.every((each) => typeof each === "number" && Number.isFinite(each));

function numbers<K extends string>(about: unknown, names: readonly K[]): Record<K, number> | null {
  const keys = keysOf(about);
  const found = {} as Record<K, number>;
  for (const name of names) {
    const value = keys[name];
    if (typeof value !== "number" || !Number.isFinite(value)) return null;
    found[name] = value;
  }
  return found;
}

function shapeOf(name: string, region: Keys): Shape | null {
  const rectangle = numbers(region["rectangle_um"], ["x", "y", "width", "height"] as const);
  if (rectangle) return { name, kind: "rectangle", ...rectangle };
  const circle = numbers(region["circle_um"], ["x", "y", "radius"] as const);
  if (circle) return { name, kind: "circle", ...circle };
  const points = region["polygon_um"];
  if (Array.isArray(points) && points.length > 2 && points.every(isPoint)) return { name, kind: "polygon", points };
  return null;
}

export function shapesOf(recipe: unknown): Drawn {
  const evaluation = keysOf(keysOf(recipe)["evaluation"]);
  const drawn: Drawn = { shapes: [], notDrawn: [] };
  for (const [name, region] of Object.entries(keysOf(evaluation["regions"]))) {
    const shape = shapeOf(name, keysOf(region));
    if (shape) drawn.shapes.push(shape);
    else drawn.notDrawn.push(name);
  }
  for (const [name, measurement] of Object.entries(keysOf(evaluation["measurements"]))) {
    const { from_um, to_um } = keysOf(measurement);
    if (isPoint(from_um) && isPoint(to_um)) drawn.shapes.push({ name, kind: "line", points: [from_um, to_um] });
  }
  return drawn;
}

// um on the object of a pixel of the camera's image; null where the recipe does not tell.
export function pitchOf(recipe: unknown): { x: number; y: number } | null {
  const lateral = keysOf(keysOf(keysOf(recipe)["reconstruct"])["lateral"]);
  const found = numbers(lateral, ["pixel_pitch_x_um", "pixel_pitch_y_um"] as const);
  return found ? { x: found.pixel_pitch_x_um, y: found.pixel_pitch_y_um } : null;
}
