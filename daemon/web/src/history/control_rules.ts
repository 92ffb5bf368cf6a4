// Rules of Western Electric on a row of values: whether a process is out of control, which limits of parts do not tell.
export interface Centre {
  mean: number;
  sigma: number;  // from the mean moving range: a drift does not widen it
  count: number;
}

export interface Mark {
  rule1: boolean;  // beyond three sigma
  rule4: boolean;  // the eighth or later in a row on one side of the mean
}

const kRangeOfTwo = 1.128;  // expected range of two values in sigma (d2 of ISO 7870-2)
const kRun = 8;

// null where two values are not there to tell a spread. Jobs without a value count for nothing.
export function centreOf(values: readonly (number | null)[]): Centre | null {
  const valid = values.filter((value): value is number => value !== null && Number.isFinite(value));
  if (valid.length < 2) return null;
  const mean = valid.reduce((sum, value) => sum + value, 0) / valid.length;
  let ranges = 0;
  for (let i = 1; i < valid.length; ++i) ranges += Math.abs((valid[i] as number) - (valid[i - 1] as number));
  return { mean, sigma: ranges / (valid.length - 1) / kRangeOfTwo, count: valid.length };
}

export function marksOf(values: readonly (number | null)[], centre: Centre | null): Mark[] {
  let side = 0;
  let run = 0;
  return values.map((value) => {
    if (value === null || centre === null || !Number.isFinite(value)) return { rule1: false, rule4: false };
    const now = Math.sign(value - centre.mean);
    run = now === 0 ? 0 : now === side ? run + 1 : 1;
    side = now;
    return { rule1: Math.abs(value - centre.mean) > 3 * centre.sigma, rule4: run >= kRun };
  });
}
