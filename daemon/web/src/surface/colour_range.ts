// Between which values the colours run.
import type { Range } from "./colours.ts";

// So that the share `low` of the valid values lies below the range and `1 - high` above it; by the nearest rank, null
// where nothing is valid.
export function percentileRange(values: Float32Array, low: number, high: number): Range | null {
  const valid = values.filter((value) => !Number.isNaN(value)).sort();
  if (valid.length === 0) return null;
  const at = (share: number): number => {
    const rank = Math.ceil(Math.max(0, Math.min(1, share)) * valid.length) - 1;
    return valid[Math.max(0, rank)] ?? NaN;
  };
  return { low: at(low), high: at(high) };
}

// Lowest and highest valid value, of planes that hold lowest and highest of blocks.
export function wholeRange(lowest: Float32Array, highest: Float32Array): Range | null {
  let low = Infinity;
  let high = -Infinity;
  for (const value of lowest) if (value < low) low = value;
  for (const value of highest) if (value > high) high = value;
  return low <= high ? { low, high } : null;
}
