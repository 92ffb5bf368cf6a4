// How high the regions of a recipe lie above each other in a map, as the daemon measures it: each pair by parallel planes
// (core/metrology/step). Plain means would take a tilted part's slope for a step, and may have the other sign.
import type { Tile } from "../surface/height_tile.ts";
import { type Drawn, type Point, contains, drawingsOf } from "./drawing.ts";
import { type Json, isObject } from "./schema.ts";

// In um; undefined where the map does not tell. slope: as the measurement's key of that name.
export type StepHeight = (lower: string, upper: string, slope?: string) => number | undefined;

export const kUnknownHeights: StepHeight = () => undefined;

interface Plane {
  count: number;
  x: number;  // centre, in um
  y: number;
  z: number;
  xx: number;  // scatter about it
  xy: number;
  yy: number;
  xz: number;
  yz: number;
}

// As the daemon: points that spread over less than this share of both directions' product lie on one line.
const kNoSpread = 1e-10;

function samplesIn(shape: Drawn, heights: Tile, pitch_um: Point): [number, number, number][] {
  const found: [number, number, number][] = [];
  for (let row = 0; row < heights.height; ++row) {
    for (let column = 0; column < heights.width; ++column) {
      const height_m = heights.mean[row * heights.width + column] ?? NaN;
      if (Number.isNaN(height_m)) continue;
      // A sample stands for a block of points; its middle counts.
      const at = { x: (column + 0.5) * heights.factor * pitch_um.x, y: (row + 0.5) * heights.factor * pitch_um.y };
      if (contains(shape, at, 0)) found.push([at.x, at.y, 1e6 * height_m]);
    }
  }
  return found;
}

function planeOf(samples: readonly [number, number, number][]): Plane {
  const count = samples.length;
  let [x, y, z] = [0, 0, 0];
  for (const [at_x, at_y, height] of samples) [x, y, z] = [x + at_x / count, y + at_y / count, z + height / count];
  const plane = { count, x, y, z, xx: 0, xy: 0, yy: 0, xz: 0, yz: 0 };
  for (const [at_x, at_y, height] of samples) {
    const [dx, dy, dz] = [at_x - x, at_y - y, height - z];
    plane.xx += dx * dx;
    plane.xy += dx * dy;
    plane.yy += dy * dy;
    plane.xz += dx * dz;
    plane.yz += dy * dz;
  }
  return plane;
}

// Of the planes' common slope; null where their samples define none.
function slopeOf(planes: readonly Plane[]): Point | null {
  const sum = (key: "xx" | "xy" | "yy" | "xz" | "yz"): number => planes.reduce((all, plane) => all + plane[key], 0);
  const [xx, xy, yy, xz, yz] = [sum("xx"), sum("xy"), sum("yy"), sum("xz"), sum("yz")];
  const determinant = xx * yy - xy * xy;
  return determinant > kNoSpread * xx * yy ? { x: (yy * xz - xy * yz) / determinant, y: (xx * yz - xy * xz) / determinant } : null;
}

// Of regions that can be drawn and have valid points.
export function stepHeights(document: Json, heights: Tile, pitch_um: Point): StepHeight {
  const planes = new Map<string, Plane>();
  for (const shape of drawingsOf(document)) {
    if (shape.kind === "line") continue;
    const samples = samplesIn(shape, heights, pitch_um);
    if (samples.length > 0) planes.set(shape.name, planeOf(samples));
  }
  return (lower, upper, slope = "common_plane") => {
    const [low, high] = [planes.get(lower), planes.get(upper)];
    if (!low || !high) return undefined;
    const tilt = slope === "fixed" ? { x: 0, y: 0 } : slopeOf(slope === "from_lower" ? [low] : slope === "from_upper" ? [high] : [low, high]);
    return tilt === null ? undefined : high.z - low.z - tilt.x * (high.x - low.x) - tilt.y * (high.y - low.y);
  };
}

// What a measurement "step_between" becomes in that map. Of a surface that was made of it (levelled, inverted) it tells nothing.
export function heightOfStep(measurement: Json | undefined, heightOf: StepHeight): number | undefined {
  if (!isObject(measurement) || (measurement["surface"] ?? "measured") !== "measured") return undefined;
  const { lower, upper, slope } = measurement;
  return heightOf(String(lower ?? ""), String(upper ?? ""), typeof slope === "string" ? slope : undefined);
}
