// So many decimals that U has two digits that count; without U so many that the value has five.
export function decimals(value: number, U: number | null): number {
  const of = U !== null && U > 0 ? U : Math.abs(value);
  const digits = U !== null && U > 0 ? 2 : 5;
  if (of === 0 || !Number.isFinite(of)) return 2;
  // Rounding may add a digit: 0.0996 is 0.10 with two digits.
  const exponent = Math.floor(Math.log10(Number(of.toPrecision(digits))));
  return Math.min(6, Math.max(0, digits - 1 - exponent));
}

export function unitForPeople(unit: string): string {
  switch (unit) {
    case "um": return "µm";
    case "um2": return "µm²";
    case "deg": return "°";
    case "1": return "";
    default: return unit;
  }
}
