// Round numbers for scales.

// 1, 2 or 5 times a power of ten: the largest that is not above the wish.
export function roundBelow(wish: number): number {
  if (!(wish > 0) || !Number.isFinite(wish)) return 1;
  const power = 10 ** Math.floor(Math.log10(wish) + 1e-12);
  const rest = wish / power;
  // Powers below one are not exact.
  return Number(((rest >= 5 - 1e-9 ? 5 : rest >= 2 - 1e-9 ? 2 : 1) * power).toPrecision(1));
}

// Round values from low to high, at most `most` of them.
export function ticks(low: number, high: number, most: number): { values: number[]; digits: number } {
  if (!(high > low) || most < 2) return { values: Number.isFinite(low) ? [low] : [], digits: 2 };
  let step = roundBelow((high - low) / most);
  while (Math.floor(high / step + 1e-9) - Math.ceil(low / step - 1e-9) + 1 > most) step = roundBelow(step * 2.5);
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const values: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i <= Math.floor(high / step + 1e-9); ++i) {
    values.push(Number((i * step).toFixed(Math.min(20, digits + 2))) + 0);
  }
  return { values, digits };
}

// Length of a scale bar: round, and at most so many of what the view shows.
export const barLength = (most: number): number => roundBelow(most);
