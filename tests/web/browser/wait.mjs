// Waits for conditions with generous bounds; nothing here sleeps a fixed time to be lucky.

// CLOCK_MONOTONIC, in ms.
export const now_ms = () => Number(process.hrtime.bigint() / 1000n) / 1000;

export async function until(what, condition, within_ms = 30000) {
  const end = performance.now() + within_ms;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (performance.now() > end) throw new Error(`${what}: not within ${within_ms} ms`);
    await new Promise((wake) => setTimeout(wake, 10));
  }
}
