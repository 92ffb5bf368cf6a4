// How high the regions of a recipe lie in a map.
import type { Tile } from "../surface/height_tile.ts";
import { type Point, contains, drawingsOf } from "./drawing.ts";
import type { Json } from "./schema.ts";

// Mean height in um by the region's name; a region that cannot be drawn, or has no valid point, is not in it.
export function regionHeights(document: Json, heights: Tile, pitch_um: Point): Map<string, number> {
  const found = new Map<string, number>();
  for (const shape of drawingsOf(document)) {
    if (shape.kind === "line") continue;
    let [sum_m, count] = [0, 0];
    for (let row = 0; row < heights.height; ++row) {
      for (let column = 0; column < heights.width; ++column) {
        const height_m = heights.mean[row * heights.width + column] ?? NaN;
        if (Number.isNaN(height_m)) continue;
        // A sample stands for a block of points; its middle counts.
        const at = { x: (column + 0.5) * heights.factor * pitch_um.x, y: (row + 0.5) * heights.factor * pitch_um.y };
        if (!contains(shape, at, 0)) continue;
        sum_m += height_m;
        ++count;
      }
    }
    if (count > 0) found.set(shape.name, (1e6 * sum_m) / count);
  }
  return found;
}
