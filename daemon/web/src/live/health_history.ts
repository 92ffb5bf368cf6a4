// What the daemon told of its devices while this tab was open, for the sparklines: a bounded memory, no request of its own.
import { createStore } from "../lib/store.ts";
import { type Topics, topics } from "./live.ts";

export interface Sample {
  at_ms: number;
  values: Record<string, number>;  // by path, as "stage.latency_p99_us"
}

const kMost = 600;
const kEvery_ms = 1000;

// All numbers of an object by their paths: what the daemon adds shows up by itself.
export function numbersOf(value: unknown, path = ""): Record<string, number> {
  if (typeof value === "number" && Number.isFinite(value)) return { [path]: value };
  if (value === null || typeof value !== "object" || Array.isArray(value)) return {};
  const found: Record<string, number> = {};
  for (const [name, inner] of Object.entries(value)) Object.assign(found, numbersOf(inner, path ? `${path}.${name}` : name));
  return found;
}

// At most one sample a second; the newest within it counts.
export function remember(samples: readonly Sample[], health: Topics["health"], now_ms: number): Sample[] {
  if (health === null) return [...samples];
  const sample = { at_ms: now_ms, values: numbersOf(health) };
  const last = samples.at(-1);
  if (last && now_ms - last.at_ms < kEvery_ms) return [...samples.slice(0, -1), { ...sample, at_ms: last.at_ms }];
  return [...samples, sample].slice(-kMost);
}

// One metric over time; of a counter (that only grows) what it grew by a second.
export function seriesOf(samples: readonly Sample[], path: string, isCounter: boolean): [number, number][] {
  const told = samples.filter(({ values }) => path in values).map(({ at_ms, values }): [number, number] => [at_ms / 1000, values[path] ?? 0]);
  if (!isCounter) return told;
  const rates: [number, number][] = [];
  for (let i = 1; i < told.length; ++i) {
    const [from_s, before] = told[i - 1] ?? [0, 0];
    const [to_s, after] = told[i] ?? [0, 0];
    // A counter begins anew when a device is opened again.
    rates.push([to_s, Math.max(0, after - before) / (to_s - from_s)]);
  }
  return rates;
}

export const healthHistory = createStore<Sample[]>([]);

// Begins to remember; call the result to end it.
export function rememberHealth(): () => void {
  let last: Topics["health"] = null;
  return topics.watch(() => {
    const { health } = topics.get();
    if (health === last) return;
    last = health;
    healthHistory.update((samples) => remember(samples, health, performance.now()));
  });
}
