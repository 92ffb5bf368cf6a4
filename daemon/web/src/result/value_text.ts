// How values are written: no more digits than their uncertainty lets one believe.

// "um^2" is µm², "deg" °; a pure number has no unit.
export function unitText(unit: string): string {
  if (unit === "1" || unit === "um/um") return "";
  if (unit === "deg") return "°";
  if (unit === "percent") return "%";
  return unit.replace(/\bum/g, "µm").replace("^2", "²").replace("^3", "³");
}

// "height_um" is the key of the value "height": the unit has a column of its own.
export function nameOf(key: string): string {
  const plain = key.replace(/_(um|um2|um3|deg|percent|px)$/, "");
  return plain.replaceAll("_", " ");
}

const kMost = 6;

// Decimals that show two digits of U; without U four digits of the value itself.
export function digitsFor(value: number, U?: number): number {
  const leading = (of: number, digits: number): number => {
    if (!(Math.abs(of) > 0) || !Number.isFinite(of)) return 0;
    return Math.max(0, Math.min(kMost, digits - 1 - Math.floor(Math.log10(Math.abs(of)))));
  };
  if (U !== undefined && U > 0) return leading(U, 2);
  if (Number.isInteger(value)) return 0;  // a count
  return leading(value, 4);
}

// The share of a whole in percent, 100.0 only where it is all of it and 0.0 only where it is nothing.
export function percentDigits(fraction: number): number {
  if (fraction > 0.999 && fraction < 1) return 99.9;
  if (fraction > 0 && fraction < 0.001) return 0.1;
  return Math.round(fraction * 1000) / 10;
}
