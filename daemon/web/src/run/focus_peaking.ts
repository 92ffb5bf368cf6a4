// Marks in a live picture: what is sharp, and what is too bright.
export interface Marks {
  focus: boolean;
  saturation: boolean;
}

export const kSharp = 56;       // bend of the grey levels across a pixel from which it counts as sharp
export const kSaturated = 252;  // JPEG does not keep 255 exactly
export const kFocusColour = [0, 214, 255] as const;
export const kSaturatedColour = [255, 40, 160] as const;

// Paints into RGBA bytes; the picture's grey is its green.
export function paintMarks(rgba: Uint8ClampedArray, width: number, height: number, marks: Marks): void {
  if (!marks.focus && !marks.saturation) return;
  const grey = new Uint8Array(width * height);
  for (let i = 0; i < grey.length; ++i) grey[i] = rgba[4 * i + 1] as number;
  const paint = (i: number, colour: readonly [number, number, number]): void => rgba.set(colour, 4 * i);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const i = y * width + x;
      const here = grey[i] as number;
      if (marks.saturation && here >= kSaturated) {
        paint(i, kSaturatedColour);
      } else if (marks.focus && x > 0 && y > 0 && x < width - 1 && y < height - 1) {
        const bend_x = Math.abs(2 * here - (grey[i - 1] as number) - (grey[i + 1] as number));
        const bend_y = Math.abs(2 * here - (grey[i - width] as number) - (grey[i + width] as number));
        if (bend_x + bend_y >= kSharp) paint(i, kFocusColour);
      }
    }
  }
}
