// Colours of values: viridis for heights, as in the result's pictures; grey for the texture.
const kViridis = ("440154 460c5f 48186a 482273 472c7a 453681 423f85 3e4889 3b518b 375a8c 33628d 2f6a8e 2c718e 29798e 26818e 23888e 21908c " +
  "1f978b 1f9f88 21a685 27ad80 31b57a 3dbc73 4cc26b 5cc862 6ece57 81d34c 95d83f aadc31 c0df24 d4e21a eae51a fde725")
  .split(" ").map((text) => parseInt(text, 16));

export const kHoleColour = 0xababab;

// 256 colours 0xRRGGBB between equally spaced ones.
function table(stops: readonly number[]): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (stops.length - 1);
    const below = Math.min(Math.floor(at), stops.length - 2);
    const part = (shift: number): number => {
      const a = ((stops[below] ?? 0) >> shift) & 255;
      const b = ((stops[below + 1] ?? 0) >> shift) & 255;
      return Math.round(a + (b - a) * (at - below));
    };
    return (part(16) << 16) | (part(8) << 8) | part(0);
  });
}

export const kViridisTable = table(kViridis);
// Two colours that part in the middle, for what lies above and below.
export const kPartingTable = table([0x053061, 0x4393c3, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xd6604d, 0x67001f]);
export const kGreyTable = table([0x000000, 0xffffff]);

export interface Range {
  low: number;
  high: number;
}

// Index into a table of 256 colours; what lies outside has the ends' colours.
export function level(value: number, { low, high }: Range): number {
  if (!(high > low)) return value > high ? 255 : value < low ? 0 : 128;
  return Math.max(0, Math.min(255, Math.round(((value - low) / (high - low)) * 255)));
}

export const cssColour = (colour: number): string => `#${colour.toString(16).padStart(6, "0")}`;

// 0xRRGGBB as the word of an ImageData on a little-endian machine: bytes R, G, B, A.
export const rgba = (colour: number): number =>
  (0xff000000 | ((colour & 0xff) << 16) | (colour & 0xff00) | (colour >> 16)) >>> 0;
