// Timers that go on only when a test says so. Those of Node's own runner are asked for otherwise in Node 18 than in later ones.
interface Timer {
  due_ms: number;
  every_ms: number | null;  // null = once
  call: () => void;
}

const kOwn = { setTimeout, clearTimeout, setInterval, clearInterval };
const timers = new Map<number, Timer>();
let now_ms = 0;
let last = 0;

function set(call: () => void, after_ms: number, every_ms: number | null): number {
  timers.set(++last, { due_ms: now_ms + after_ms, every_ms, call });
  return last;
}
const clear = (id: unknown): void => void timers.delete(id as number);

export function stopTimers(): void {
  timers.clear();
  Object.assign(globalThis, {
    setTimeout: (call: () => void, after_ms = 0) => set(call, after_ms, null),
    setInterval: (call: () => void, every_ms: number) => set(call, every_ms, every_ms),
    clearTimeout: clear,
    clearInterval: clear,
  });
}

export const letTimersGo = (): void => void Object.assign(globalThis, kOwn);

// Calls what falls due, in its order.
export function passTime(by_ms: number): void {
  const end_ms = now_ms + by_ms;
  for (;;) {
    const [id, timer] = [...timers].sort(([, a], [, b]) => a.due_ms - b.due_ms)[0] ?? [];
    if (id === undefined || !timer || timer.due_ms > end_ms) break;
    now_ms = timer.due_ms;
    if (timer.every_ms === null) timers.delete(id);
    else timer.due_ms += timer.every_ms;
    timer.call();
  }
  now_ms = end_ms;
}

// What is answered is read in microtasks and turns of the loop, which stopped timers do not hold up.
export async function turns(): Promise<void> {
  for (let i = 0; i < 5; ++i) await new Promise((done) => setImmediate(done));
}
