// What a focus curve of the picture's middle tells about a scan: its range, its step.
import { roundBelow } from "../surface/ticks.ts";

export type CurvePoint = readonly [number, number];  // z in um, sharpness

export interface FocusCurve {
  peak_um: number;
  width_um: number;    // full width at half maximum of the sharpest peak
  first_um: number;    // the curve stands out of its ground from here
  last_um: number;     // to here: also lower peaks, of other heights in the picture
  base: number;
  top: number;
}

const kStandsOut = 0.2;  // of the sharpest peak over the ground

// null where the curve has no peak: nothing in the range was sharp, or it is sharpest at an end.
export function readCurve(points: readonly CurvePoint[]): FocusCurve | null {
  const curve = [...points].sort((a, b) => a[0] - b[0]);
  if (curve.length < 5) return null;
  const focus = curve.map(([, value]) => value);
  const top = Math.max(...focus);
  const base = Math.min(...focus);
  const at = focus.indexOf(top);
  // Repeated looks at one place differ by noise; a peak is more than that.
  if (!(top > base * 1.2 + 1e-12) || at === 0 || at === curve.length - 1) return null;
  const half = (top + base) / 2;
  const crossing = (way: -1 | 1): number | null => {
    for (let i = at; i + way >= 0 && i + way < curve.length; i += way) {
      const [z0, f0] = curve[i] as CurvePoint;
      const [z1, f1] = curve[i + way] as CurvePoint;
      if (f1 <= half) return f0 === f1 ? z1 : z0 + ((f0 - half) / (f0 - f1)) * (z1 - z0);
    }
    return null;
  };
  const [left, right] = [crossing(-1), crossing(1)];
  if (left === null || right === null) return null;
  const out = curve.filter(([, value]) => value >= base + kStandsOut * (top - base));
  return { peak_um: (curve[at] as CurvePoint)[0], width_um: right - left, first_um: (out[0] as CurvePoint)[0], last_um: (out[out.length - 1] as CurvePoint)[0], base, top };
}

export interface Scan {
  start_um: number;
  step_um: number;
  slices: number;
}

const kSlicesInWidth = 5;
const kLeastSlices = 8;
const kMostSlices = 2000;

// Five slices within the focus curve's width; the part's heights and once the width beyond on either side.
export function suggestScan(curve: FocusCurve): Scan {
  const step_um = roundBelow(curve.width_um / kSlicesInWidth);
  const start_um = Math.floor((curve.first_um - curve.width_um) / step_um) * step_um;
  const end_um = curve.last_um + curve.width_um;
  const slices = Math.min(kMostSlices, Math.max(kLeastSlices, Math.ceil((end_um - start_um) / step_um) + 1));
  return { start_um: Number(start_um.toPrecision(12)), step_um, slices };
}

// The window after a trial: a larger one where many points are holes, for weak texture needs more of it.
export function suggestWindow(valid_fraction: number, window_px: number): number {
  return valid_fraction < 0.85 ? Math.min(31, window_px + 4) : window_px;
}
