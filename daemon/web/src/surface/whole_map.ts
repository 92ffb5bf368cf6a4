// Every point of a job's map, for what is computed of all of them.
import { type Tile, fetchTile } from "./height_tile.ts";

const kSide = 1024;  // of a piece, points

export interface WholeMap {
  width: number;
  height: number;
  values: Float32Array;  // metres, row by row from the top, NaN = hole
}

// known: a tile of the map, for its size.
export async function fetchWholeMap(job: string, known: Tile, signal?: AbortSignal, load: typeof fetchTile = fetchTile): Promise<WholeMap> {
  const { map_width: width, map_height: height } = known;
  const values = new Float32Array(width * height);
  for (let y = 0; y < height; y += kSide) {
    for (let x = 0; x < width; x += kSide) {
      const piece = await load(job, "height", { x, y, w: Math.min(kSide, width - x), h: Math.min(kSide, height - y) }, kSide, signal);
      if (piece.factor !== 1) throw new Error(`height: reduced by ${piece.factor} although ${kSide} samples were allowed`);
      for (let row = 0; row < piece.height; ++row) values.set(piece.mean.subarray(row * piece.width, (row + 1) * piece.width), (y + row) * width + x);
    }
  }
  return { width, height, values };
}
