// Values of a tile as the pixels of a picture.
import { type Range, kHoleColour, level, rgba } from "./colours.ts";
import { mainReason } from "./hole_reasons.ts";

export function paintValues(values: Float32Array, range: Range, table: Uint32Array, pixels: Uint32Array): void {
  const words = table.map(rgba);
  const hole = rgba(kHoleColour);
  for (let i = 0; i < values.length; ++i) {
    const value = values[i] as number;
    pixels[i] = Number.isNaN(value) ? hole : (words[level(value, range)] as number);
  }
}

export function pictureOf(values: Float32Array, width: number, height: number, range: Range, table: Uint32Array): ImageData {
  const picture = new ImageData(width, height);
  paintValues(values, range, table, new Uint32Array(picture.data.buffer));
  return picture;
}

// Points that are valid are pale: the holes are what one looks for here.
export const kValidColour = 0xeef2f5;

export function paintReasons(values: Float32Array, pixels: Uint32Array): void {
  const words = new Map<number, number>([[0, rgba(kValidColour)]]);
  for (let i = 0; i < values.length; ++i) {
    const bits = values[i] as number;
    let word = words.get(bits);
    if (word === undefined) {
      word = rgba(mainReason(bits)?.colour ?? kHoleColour);
      words.set(bits, word);
    }
    pixels[i] = word;
  }
}
