// The difference of two height maps after the second was moved and tilted onto the first; points are never resampled.
export interface MapShape {
  width: number;
  height: number;
  pitch_x_um: number;
  pitch_y_um: number;
}

export type Refusal = "size" | "pitch";

// A pitch is the same when its relative difference moves the map's far border by less than a hundredth of a pixel.
export function whyNotComparable(a: MapShape, b: MapShape): Refusal | null {
  if (a.width !== b.width || a.height !== b.height) return "size";
  const far = (p: number, q: number, pixels: number): boolean => Math.abs(p - q) * pixels > 0.01 * p;
  return far(a.pitch_x_um, b.pitch_x_um, a.width) || far(a.pitch_y_um, b.pitch_y_um, a.height) ? "pitch" : null;
}

export interface Difference {
  values: Float32Array;  // second minus first, aligned, metres; NaN where one of them is a hole
  points: number;        // that both have
  offset: number;        // metres, at the map's middle: what was taken away
  slope_x: number;       // metres per pixel
  slope_y: number;
  rms: number;
  least: number;
  greatest: number;
}

// null where the common points do not tell a plane: fewer than three, or all on a line.
export function differenceOf(a: Float32Array, b: Float32Array, width: number): Difference | null {
  const height = a.length / width;
  const [x0, y0] = [(width - 1) / 2, (height - 1) / 2];
  // Sums of the normal equations. Coordinates from the map's middle keep them well conditioned.
  let [n, sx, sy, sxx, sxy, syy, sd, sxd, syd] = [0, 0, 0, 0, 0, 0, 0, 0, 0];
  for (let i = 0; i < a.length; ++i) {
    const d = (b[i] as number) - (a[i] as number);
    if (Number.isNaN(d)) continue;
    const x = (i % width) - x0;
    const y = Math.floor(i / width) - y0;
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
    sd += d;
    sxd += x * d;
    syd += y * d;
  }
  if (n < 3) return null;
  const [mx, my, md] = [sx / n, sy / n, sd / n];
  const [cxx, cxy, cyy, cxd, cyd] = [sxx / n - mx * mx, sxy / n - mx * my, syy / n - my * my, sxd / n - mx * md, syd / n - my * md];
  const determinant = cxx * cyy - cxy * cxy;
  if (!(determinant > 1e-9 * (cxx + cyy) ** 2)) return null;
  const slope_x = (cxd * cyy - cyd * cxy) / determinant;
  const slope_y = (cyd * cxx - cxd * cxy) / determinant;
  const offset = md - slope_x * mx - slope_y * my;

  const values = new Float32Array(a.length);
  let [squares, least, greatest] = [0, Infinity, -Infinity];
  for (let i = 0; i < a.length; ++i) {
    const x = (i % width) - x0;
    const y = Math.floor(i / width) - y0;
    const d = (b[i] as number) - (a[i] as number) - offset - slope_x * x - slope_y * y;
    values[i] = d;
    if (Number.isNaN(d)) continue;
    squares += d * d;
    least = Math.min(least, d);
    greatest = Math.max(greatest, d);
  }
  return { values, points: n, offset, slope_x, slope_y, rms: Math.sqrt(squares / n), least, greatest };
}

// For a picture: of every block the value that is farthest from zero, so that no spike disappears. NaN where a block has no point.
export function extremes(values: Float32Array, width: number, most: number): { values: Float32Array; width: number; height: number; factor: number } {
  const height = values.length / width;
  const factor = Math.max(1, Math.ceil(Math.max(width, height) / most));
  const [w, h] = [Math.ceil(width / factor), Math.ceil(height / factor)];
  const out = new Float32Array(w * h).fill(NaN);
  for (let i = 0; i < values.length; ++i) {
    const value = values[i] as number;
    if (Number.isNaN(value)) continue;
    const at = Math.floor(Math.floor(i / width) / factor) * w + Math.floor((i % width) / factor);
    const was = out[at] as number;
    if (Number.isNaN(was) || Math.abs(value) > Math.abs(was)) out[at] = value;
  }
  return { values: out, width: w, height: h, factor };
}
