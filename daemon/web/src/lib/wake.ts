// When this computer wakes from sleep. Timers stood still then, and connections may be dead without having said so.
// The clock of the day goes on in sleep, that of the timers does not; where it does, the timers notice for themselves. The
// day itself does not matter, and a clock that is set forward looks like a sleep, which does no harm.

export interface Moment {
  clock_ms: number;    // of the day
  running_ms: number;  // while awake
}

export const moment = (): Moment => ({ clock_ms: Date.now(), running_ms: performance.now() });

export const sleptFor_ms = (before: Moment, now: Moment): number =>
  Math.max(0, now.clock_ms - before.clock_ms - (now.running_ms - before.running_ms));

const kLook_ms = 2000;
const kLeast_ms = 5000;  // clocks are corrected by less

export function onWake(woken: (slept_ms: number) => void): () => void {
  let before = moment();
  const timer = setInterval(() => {
    const now = moment();
    const slept_ms = sleptFor_ms(before, now);
    before = now;
    if (slept_ms > kLeast_ms) woken(slept_ms);
  }, kLook_ms);
  return () => clearInterval(timer);
}
