// How many decimals a number has for people: no more than one can believe.
const kMost = 12;

// The place of the first digit that counts, when so many of them are shown: 0.0996 is 0.10 with two.
const exponentOf = (value: number, digits: number): number => Math.floor(Math.log10(Number(Math.abs(value).toPrecision(digits))));

// So many that count, and never the tail of a binary fraction; none of a whole number.
export function usefulDigits(value: number, significant = 4): number {
  if (!Number.isFinite(value) || Number.isInteger(value)) return 0;
  return Math.min(kMost, Math.max(0, significant - 1 - exponentOf(value, significant)));
}

// As far as the uncertainty's second digit: more would be invented.
export function digitsOfUncertain(uncertainty: number): number {
  if (!Number.isFinite(uncertainty) || uncertainty <= 0) return 0;
  return Math.min(kMost, Math.max(0, 1 - exponentOf(uncertainty, 2)));
}

const kMostMeasured = 6;

// Of what was measured: by its U, and where that is not known five that count.
export function digitsOf(value: number, U: number | null | undefined): number {
  return Math.min(kMostMeasured, typeof U === "number" && U > 0 ? digitsOfUncertain(U) : usefulDigits(value, 5));
}
