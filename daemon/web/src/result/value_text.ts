// How names and shares are written.

// "height_um" is the key of the value "height": the unit has a column of its own.
export function nameOf(key: string): string {
  const plain = key.replace(/_(um|um2|um3|deg|percent|px)$/, "");
  return plain.replaceAll("_", " ");
}

// The share of a whole in percent, 100.0 only where it is all of it and 0.0 only where it is nothing.
export function percentDigits(fraction: number): number {
  if (fraction > 0.999 && fraction < 1) return 99.9;
  if (fraction > 0 && fraction < 0.001) return 0.1;
  return Math.round(fraction * 1000) / 10;
}
