// Heights as a picture: colours that rise evenly in lightness, or two that part at zero; holes are transparent.
type Colour = readonly [number, number, number];

const kRising: readonly Colour[] = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const kParting: readonly Colour[] = [[5, 48, 97], [67, 147, 195], [209, 229, 240], [247, 247, 247], [253, 219, 199], [214, 96, 77], [103, 0, 31]];

// Of 0 … 1; beyond it the colour of the end.
export function colourOf(share: number, parting = false): Colour {
  const anchors = parting ? kParting : kRising;
  const at = Math.min(1, Math.max(0, share)) * (anchors.length - 1);
  const i = Math.min(anchors.length - 2, Math.floor(at));
  const [a, b] = [anchors[i] as Colour, anchors[i + 1] as Colour];
  const mix = (k: 0 | 1 | 2): number => Math.round(a[k] + (b[k] - a[k]) * (at - i));
  return [mix(0), mix(1), mix(2)];
}

// From and to of the middle part of the values: a spike does not take the colours from everything else.
export function rangeOf(values: Float32Array, outside = 0.005): { from: number; to: number; count: number } {
  const valid = values.filter((value) => !Number.isNaN(value)).sort();
  if (valid.length === 0) return { from: 0, to: 1, count: 0 };
  const at = (share: number): number => valid[Math.round(share * (valid.length - 1))] ?? 0;
  const [from, to] = [at(outside), at(1 - outside)];
  return from < to ? { from, to, count: valid.length } : { from: from - 1e-9, to: to + 1e-9, count: valid.length };
}

export function paint(values: Float32Array, width: number, height: number, range: { from: number; to: number }, parting = false): ImageData {
  const picture = new ImageData(width, height);
  const table = Array.from({ length: 256 }, (_, i) => colourOf(i / 255, parting));
  for (let i = 0; i < values.length; ++i) {
    const value = values[i] as number;
    if (Number.isNaN(value)) continue;
    const colour = table[Math.round(255 * Math.min(1, Math.max(0, (value - range.from) / (range.to - range.from))))] as Colour;
    picture.data.set([colour[0], colour[1], colour[2], 255], 4 * i);
  }
  return picture;
}
