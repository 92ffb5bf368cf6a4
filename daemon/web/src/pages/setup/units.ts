// Units as the daemon writes them, and as people read them.
const kShown: Record<string, string> = {
  um: "µm", us: "µs", "um/s": "µm/s", "um2": "µm²", "px/um": "px/µm", "um/mm": "µm/mm", "degree Celsius": "°C", deg: "°", percent: "%", "1": "",
};

export const shownUnit = (unit: string): string => kShown[unit] ?? unit;

// Digits that a reader can use: four significant ones, and never the tail of a binary fraction.
export function usefulDigits(value: number, significant = 4): number {
  if (!Number.isFinite(value) || value === 0) return 0;
  const before = Math.floor(Math.log10(Math.abs(value))) + 1;
  return Number.isInteger(value) ? 0 : Math.min(12, Math.max(0, significant - before));
}

// A value goes as far as its uncertainty's second digit: more would be invented.
export function digitsOfUncertain(uncertainty: number): number {
  if (!Number.isFinite(uncertainty) || uncertainty <= 0) return 0;
  return Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(uncertainty))));
}
