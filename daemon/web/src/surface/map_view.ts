// Which part of a map a canvas shows, and which piece of it has to be fetched for that.
import type { Window } from "./height_tile.ts";

export interface MapSize {
  width: number;  // points
  height: number;
  pitch_x: number;  // µm, or 1 where the pitch is not known
  pitch_y: number;
}

// In the unit of the pitch, from the outer corner of point (0, 0); x to the right, y down.
export interface View {
  x: number;  // in the middle of the canvas
  y: number;
  scale: number;  // CSS pixels per µm
}

export interface Size {
  width: number;  // CSS pixels
  height: number;
}

const kMost = 64;  // CSS pixels a point may become; more where the whole of a small map is larger

export const extent = (map: MapSize): Size => ({ width: map.width * map.pitch_x, height: map.height * map.pitch_y });

export function fitView(map: MapSize, canvas: Size): View {
  const { width, height } = extent(map);
  return { x: width / 2, y: height / 2, scale: Math.min(canvas.width / width, canvas.height / height) };
}

// Within sensible bounds: not smaller than half of the whole, the middle inside of the map.
export function clampView(view: View, map: MapSize, canvas: Size): View {
  const { width, height } = extent(map);
  const whole = fitView(map, canvas).scale;
  const most = Math.max(4 * whole, kMost / Math.min(map.pitch_x, map.pitch_y));
  const scale = Math.max(whole / 2, Math.min(view.scale, most));
  return { x: Math.max(0, Math.min(width, view.x)), y: Math.max(0, Math.min(height, view.y)), scale };
}

export const toScreen = (view: View, canvas: Size, at: { x: number; y: number }): { x: number; y: number } => ({
  x: canvas.width / 2 + (at.x - view.x) * view.scale,
  y: canvas.height / 2 + (at.y - view.y) * view.scale,
});

export const toMap = (view: View, canvas: Size, at: { x: number; y: number }): { x: number; y: number } => ({
  x: view.x + (at.x - canvas.width / 2) / view.scale,
  y: view.y + (at.y - canvas.height / 2) / view.scale,
});

// Of a place in the window. shown: where the canvas is there, a fraction of a pixel larger than it or, until a new layout
// is measured, of another size.
export const onCanvas = (canvas: Size, shown: Size & { left: number; top: number }, at: { x: number; y: number }): { x: number; y: number } => ({
  x: ((at.x - shown.left) * canvas.width) / shown.width,
  y: ((at.y - shown.top) * canvas.height) / shown.height,
});

// The place under `at` stays under it.
export function zoomAt(view: View, canvas: Size, at: { x: number; y: number }, by: number, map: MapSize): View {
  const place = toMap(view, canvas, at);
  const { scale } = clampView({ ...view, scale: view.scale * by }, map, canvas);
  return clampView({
    x: place.x - (at.x - canvas.width / 2) / scale,
    y: place.y - (at.y - canvas.height / 2) / scale,
    scale,
  }, map, canvas);
}

// Column and row of a place; null beside the map.
export function pointAt(map: MapSize, at: { x: number; y: number }): { column: number; row: number } | null {
  const column = Math.floor(at.x / map.pitch_x);
  const row = Math.floor(at.y / map.pitch_y);
  return column >= 0 && row >= 0 && column < map.width && row < map.height ? { column, row } : null;
}

export const middleOf = (map: MapSize, { column, row }: { column: number; row: number }): { x: number; y: number } => ({
  x: (column + 0.5) * map.pitch_x,
  y: (row + 0.5) * map.pitch_y,
});

// What is seen, with a margin to move in, in steps that make neighbouring views ask for the same; and how many samples
// a side are worth fetching. Null: nothing of the map is seen.
export function wantedTile(view: View, canvas: Size, map: MapSize, device_ratio: number): { window: Window; most: number; factor: number } | null {
  const points_per_pixel = 1 / (view.scale * Math.min(map.pitch_x, map.pitch_y) * device_ratio);
  const factor = Math.max(1, 2 ** Math.floor(Math.log2(Math.max(1, points_per_pixel))));
  const step = 64 * factor;
  const from = toMap(view, canvas, { x: -canvas.width / 8, y: -canvas.height / 8 });
  const to = toMap(view, canvas, { x: canvas.width * 9 / 8, y: canvas.height * 9 / 8 });
  const first = (at: number): number => Math.max(0, Math.floor(at / step) * step);
  const past = (at: number, most: number): number => Math.min(most, Math.ceil(at / step) * step);
  const x = first(from.x / map.pitch_x);
  const y = first(from.y / map.pitch_y);
  const w = past(to.x / map.pitch_x, map.width) - x;
  const h = past(to.y / map.pitch_y, map.height) - y;
  if (w <= 0 || h <= 0) return null;
  return { window: { x, y, w, h }, most: Math.ceil(Math.max(w, h) / factor), factor };
}
