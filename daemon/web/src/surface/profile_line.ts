// Heights along a line across a map, as the daemon's own evaluation takes them (core/metrology/profile): samples one
// point apart, along and across, bilinear between the four points around them; a neighbour of any weight that is missing
// makes the sample a hole, and a hole across the band makes the profile's point one. So nothing is invented over holes.
import type { MapSize } from "./map_view.ts";

export interface Place {
  x: number;  // µm from the outer corner of point (0, 0), y down
  y: number;
}

export interface ProfileLine {
  from: Place;
  to: Place;
  width_um: number;  // of the band across it, which is averaged; below one point: the line alone
}

export interface Profile {
  distance_um: number[];
  height_um: (number | null)[];  // null = hole
  sigma_um: (number | null)[];  // standard error of a single point, mean over the band
}

interface Samples {
  count: number;
  across: number;
  length_um: number;
  place(i: number, j: number): Place;  // i along, j across
}

const kOnPoint = 1e-9;  // so near to a row or column of points a sample stands on it

export type LineProblem = "outside" | "short" | "number";

const pitchAlong = (map: MapSize, unit: Place): number => 1 / Math.hypot(unit.x / map.pitch_x, unit.y / map.pitch_y);

const middle = (piece: number, count: number, length: number): number => ((piece + 0.5) * length) / count;

function isInside(map: MapSize, { x, y }: Place): boolean {
  const end = { x: map.width * map.pitch_x, y: map.height * map.pitch_y };
  const slack = 1e-9 * (end.x + end.y);
  return x >= -slack && y >= -slack && x <= end.x + slack && y <= end.y + slack;
}

export function samplesOf(map: MapSize, line: ProfileLine): Samples | LineProblem {
  const dx = line.to.x - line.from.x;
  const dy = line.to.y - line.from.y;
  const length_um = Math.hypot(dx, dy);
  if (!Number.isFinite(length_um) || !(line.width_um >= 0) || !Number.isFinite(line.width_um)) return "number";
  const unit = length_um > 0 ? { x: dx / length_um, y: dy / length_um } : { x: 1, y: 0 };
  const count = Math.round(length_um / pitchAlong(map, unit));
  if (count < 2) return "short";
  const across = Math.max(1, Math.round(line.width_um / pitchAlong(map, { x: -unit.y, y: unit.x })));
  const half = across > 1 ? line.width_um / 2 : 0;
  for (const side of [-half, half]) {
    for (const { x, y } of [line.from, line.to]) {
      if (!isInside(map, { x: x - side * unit.y, y: y + side * unit.x })) return "outside";
    }
  }
  return {
    count, across, length_um,
    place: (i, j) => {
      const along = middle(i, count, length_um);
      const offset = across > 1 ? middle(j, across, line.width_um) - half : 0;
      return {
        x: line.from.x + along * unit.x - offset * unit.y,
        y: line.from.y + along * unit.y + offset * unit.x,
      };
    },
  };
}

function neighbours(position: number): { first: number; weight: number } {
  const whole = Math.round(position);
  if (Math.abs(position - whole) < kOnPoint) return { first: whole, weight: 0 };
  const first = Math.floor(position);
  return { first, weight: position - first };
}

// value(column, row): NaN for a hole, and beside the map.
export type Values = (column: number, row: number) => number;

export function sampleAt(map: MapSize, values: Values, place: Place): number {
  const x = neighbours(place.x / map.pitch_x - 0.5);
  const y = neighbours(place.y / map.pitch_y - 0.5);
  const alongRow = (row: number): number => {
    const left = values(x.first, row);
    return x.weight === 0 ? left : (1 - x.weight) * left + x.weight * values(x.first + 1, row);
  };
  const upper = alongRow(y.first);
  return y.weight === 0 ? upper : (1 - y.weight) * upper + y.weight * alongRow(y.first + 1);
}

// heights and sigmas in µm.
export function profileOf(map: MapSize, samples: Samples, heights: Values, sigmas: Values): Profile {
  const profile: Profile = { distance_um: [], height_um: [], sigma_um: [] };
  const mean = (values: Values, i: number): number | null => {
    let sum = 0;
    for (let j = 0; j < samples.across; ++j) sum += sampleAt(map, values, samples.place(i, j));
    return Number.isNaN(sum) ? null : sum / samples.across;
  };
  for (let i = 0; i < samples.count; ++i) {
    const height = mean(heights, i);
    profile.distance_um.push(middle(i, samples.count, samples.length_um));
    profile.height_um.push(height);
    profile.sigma_um.push(height === null ? null : mean(sigmas, i));
  }
  return profile;
}

// Each point of the map that the samples ask for, once a block of `side` points: what has to be fetched beforehand.
export function blocksOf(map: MapSize, samples: Samples, side: number): { column: number; row: number }[] {
  const found = new Map<string, { column: number; row: number }>();
  const add = (column: number, row: number): void => {
    if (column < 0 || row < 0 || column >= map.width || row >= map.height) return;
    const block = { column: Math.floor(column / side) * side, row: Math.floor(row / side) * side };
    found.set(`${block.column} ${block.row}`, block);
  };
  for (let i = 0; i < samples.count; ++i) {
    for (let j = 0; j < samples.across; ++j) {
      const { x, y } = samples.place(i, j);
      const column = Math.floor(x / map.pitch_x - 0.5 + kOnPoint);
      const row = Math.floor(y / map.pitch_y - 0.5 + kOnPoint);
      for (const more_x of [0, 1]) for (const more_y of [0, 1]) add(column + more_x, row + more_y);
    }
  }
  return [...found.values()];
}
