// Why points have no height: bits of mask.png, in the order in which one is shown for a point that has several.
export interface HoleReason {
  bit: number;
  name: string;  // as in result.json's hole_points
  colour: number;  // 0xRRGGBB, as in holes.png
}

export const kHoleReasons: readonly HoleReason[] = [
  { bit: 16384, name: "out_of_view", colour: 0x808080 },
  { bit: 16, name: "saturated", colour: 0xe6194b },
  { bit: 2, name: "first_slice", colour: 0x0082c8 },
  { bit: 4, name: "last_slice", colour: 0x46c8f0 },
  { bit: 1, name: "low_prominence", colour: 0x3c3c3c },
  { bit: 32, name: "insignificant", colour: 0xaa6e28 },
  { bit: 8, name: "not_bracketed", colour: 0x911eb4 },
  { bit: 64, name: "edge_bleeding", colour: 0xf58231 },
  { bit: 128, name: "broad_curve", colour: 0x008080 },
  { bit: 256, name: "narrow_curve", colour: 0xd2f53c },
  { bit: 512, name: "second_peak", colour: 0xf032e6 },
  { bit: 1024, name: "edge_band", colour: 0xffd21e },
  { bit: 2048, name: "max_sigma", colour: 0x000080 },
  { bit: 4096, name: "outlier", colour: 0x3cb44b },
];

export const kUnknownReason: HoleReason = { bit: 0, name: "unknown", colour: 0xffffff };

// All reasons of a point; none = it is valid.
export function reasonsOf(bits: number): HoleReason[] {
  const found = kHoleReasons.filter(({ bit }) => (bits & bit) !== 0);
  return found.length === 0 && bits !== 0 ? [kUnknownReason] : found;
}

// What says most of a point.
export const mainReason = (bits: number): HoleReason | null => reasonsOf(bits)[0] ?? null;
