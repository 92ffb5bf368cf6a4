// Times of this program, of the page and of the simulated stage on one clock: CLOCK_MONOTONIC, in ms.
import { now_ms } from "../../web/browser/wait.mjs";

export { now_ms };

// What has to be added to the page's performance.now(). The tightest of several looks counts: within half of its width.
export async function offsetOf(page) {
  let best = { width_ms: Infinity, offset_ms: NaN };
  for (let i = 0; i < 40; ++i) {
    const before = now_ms();
    const there = await page.evaluate(() => performance.now());
    const after = now_ms();
    if (after - before < best.width_ms) best = { width_ms: after - before, offset_ms: (before + after) / 2 - there };
  }
  return best.offset_ms;
}

export const percentile = (values, fraction) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(fraction * values.length))];

export function told(name, values_ms) {
  const text = [0.5, 0.9, 0.99].map((each) => percentile(values_ms, each).toFixed(1)).join(", ");
  console.error(`${name}: median, p90, p99 ${text} ms, longest ${Math.max(...values_ms).toFixed(1)} ms of ${values_ms.length}`);
}

export const rounded = (value, digits = 1) => Number(value.toFixed(digits));
