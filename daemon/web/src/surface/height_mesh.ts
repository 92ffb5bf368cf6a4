// A tile as a mesh: a vertex a sample, two triangles where all of their corners are valid, so that holes stay open.
import { type Range, level } from "./colours.ts";
import type { Tile } from "./height_tile.ts";

export interface Mesh {
  columns: number;
  rows: number;
  positions: Float32Array;  // x to the right, y up (the image's rows go down), z: the height; in the pitch's unit, µm
  colours: Uint8Array;  // r, g, b, 255 a vertex
  triangles: Uint32Array;
}

export interface MeshScale {
  pitch_x: number;
  pitch_y: number;
}

const kStripe = 16;  // squares: the corners of a row are still at hand as the next one is drawn

// In stripes from top to bottom. Corners of a square are a b / c d. A square with one hole keeps the triangle of the other three.
export function trianglesOf(heights: Float32Array, columns: number, rows: number): Uint32Array {
  const found = new Uint32Array(Math.max(0, 6 * (columns - 1) * (rows - 1)));
  let at = 0;
  const valid = (i: number): boolean => !Number.isNaN(heights[i]);
  const add = (a: number, b: number, c: number): void => {
    found[at++] = a;
    found[at++] = b;
    found[at++] = c;
  };
  for (let left = 0; left + 1 < columns; left += kStripe) {
    const right = Math.min(left + kStripe, columns - 1);
    for (let row = 0; row + 1 < rows; ++row) {
      for (let column = left; column < right; ++column) {
        const a = row * columns + column;
        const b = a + 1;
        const c = a + columns;
        const d = c + 1;
        const [va, vb, vc, vd] = [valid(a), valid(b), valid(c), valid(d)];
        if (va && vd) {
          if (vb) add(a, d, b);
          if (vc) add(a, c, d);
        } else if (vb && vc) {
          if (va) add(a, c, b);
          if (vd) add(b, c, d);
        }
      }
    }
  }
  return found.slice(0, at);
}

// How light a vertex is, 0.35 to 1: light from the upper left. slope: rise per µm to the right and up.
export function shade(slope_x: number, slope_y: number): number {
  const length = Math.hypot(slope_x, slope_y, 1);
  const towards = (0.45 * slope_x - 0.45 * slope_y + 0.77) / length;
  return 0.35 + 0.65 * Math.max(0, Math.min(1, towards));
}

// Slopes between the valid neighbours of a sample, of z in µm times the exaggeration.
export function slopesAt(z: (column: number, row: number) => number, column: number, row: number, step_x: number, step_y: number): [number, number] {
  const along = (before: number, here: number, after: number, step: number): number => {
    if (!Number.isNaN(before) && !Number.isNaN(after)) return (after - before) / (2 * step);
    if (!Number.isNaN(after)) return (after - here) / step;
    return Number.isNaN(before) ? 0 : (here - before) / step;
  };
  const here = z(column, row);
  return [
    along(z(column - 1, row), here, z(column + 1, row), step_x),
    along(z(column, row + 1), here, z(column, row - 1), step_y),
  ];
}

// heights in metres; colour_values of the same tile (heights, or grey levels of the texture).
export function meshOf(tile: Tile, colour_values: Float32Array, range: Range, table: Uint32Array, scale: MeshScale, exaggeration: number): Mesh {
  const { width: columns, height: rows, mean, factor } = tile;
  const count = columns * rows;
  const positions = new Float32Array(3 * count);
  const colours = new Uint8Array(4 * count);
  const step_x = scale.pitch_x * factor;
  const step_y = scale.pitch_y * factor;
  const middle_x = (tile.map_width * scale.pitch_x) / 2;
  const middle_y = (tile.map_height * scale.pitch_y) / 2;
  const z = (column: number, row: number): number =>
    column < 0 || row < 0 || column >= columns || row >= rows ? NaN : (mean[row * columns + column] as number) * 1e6 * exaggeration;
  // The last block of a row or column may be cut by the border: its sample stands in the middle of what is there.
  const place = (i: number, size: number, pitch: number): number => ((i * factor + Math.min((i + 1) * factor, size)) / 2) * pitch;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const i = row * columns + column;
      const height = mean[i] as number;
      positions[3 * i] = place(column, tile.map_width, scale.pitch_x) - middle_x;
      positions[3 * i + 1] = middle_y - place(row, tile.map_height, scale.pitch_y);
      positions[3 * i + 2] = Number.isNaN(height) ? 0 : height * 1e6;
      const colour = table[level(colour_values[i] as number, range)] ?? 0;
      const light = Number.isNaN(height) ? 0 : shade(...slopesAt(z, column, row, step_x, step_y));
      colours[4 * i] = ((colour >> 16) & 255) * light;
      colours[4 * i + 1] = ((colour >> 8) & 255) * light;
      colours[4 * i + 2] = (colour & 255) * light;
      colours[4 * i + 3] = 255;
    }
  }
  return { columns, rows, positions, colours, triangles: trianglesOf(mean, columns, rows) };
}
