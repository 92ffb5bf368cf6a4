// Where a value, its interval and its limits lie on a bar from 0 to 1.
export interface LimitBar {
  lower: number | null;   // null = there is no such limit: the allowed zone is open to this side
  upper: number | null;
  value: number;          // kept on the bar; beyond says that it lies outside
  from: number;           // of the interval value - U .. value + U; equal to value where U is not known
  to: number;
  beyond: "no" | "below" | "above";
}

// null where there is nothing to draw: no value, or no limit.
export function limitBar(value: number | null, U: number | null, lower: number | null, upper: number | null): LimitBar | null {
  if (value === null || !Number.isFinite(value) || (lower === null && upper === null)) return null;
  const span = widthOf(value, U ?? 0, lower, upper);
  const begin = lower !== null ? lower - span / 2 : (upper as number) - 1.5 * span;
  const end = upper !== null ? upper + span / 2 : (lower as number) + 1.5 * span;
  const at = (x: number): number => (x - begin) / (end - begin);
  const kept = (x: number): number => Math.min(1, Math.max(0, at(x)));
  return {
    lower: lower === null ? null : at(lower),
    upper: upper === null ? null : at(upper),
    value: kept(value),
    from: kept(value - (U ?? 0)),
    to: kept(value + (U ?? 0)),
    beyond: value < begin ? "below" : value > end ? "above" : "no",
  };
}

// The tolerance; with one limit a width in which value and limit are both seen.
function widthOf(value: number, U: number, lower: number | null, upper: number | null): number {
  if (lower !== null && upper !== null) return upper > lower ? upper - lower : Math.max(Math.abs(upper), 1e-9);
  const limit = (lower ?? upper) as number;
  return Math.max(Math.abs(value - limit) * 1.2, 2 * U, Math.abs(limit) * 0.05, 1e-9);
}
