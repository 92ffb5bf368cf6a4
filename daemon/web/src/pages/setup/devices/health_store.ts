// The history of this tab, from the time it was opened.
import { createStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import { type Sample, remember } from "./health_history.ts";

export const healthHistory = createStore<Sample[]>([]);

let last: unknown = null;
topics.watch(() => {
  const { health } = topics.get();
  if (health === last) return;
  last = health;
  healthHistory.update((samples) => remember(samples, health, performance.now()));
});
