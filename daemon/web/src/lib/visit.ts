// While this page is in front of somebody. A browser keeps pages that were left, for its Back button, with their requests; six
// of them are all that it lets a site have, and the next page would wait for its first answer.
import { createStore } from "./store.ts";

const underWay = new Set<AbortController>();
let isAway = false;

// Counts how often the page was left: what was pressed before may not begin when it comes back.
export const leavings = createStore(0);

// The work's signal ends with the outer one, and when the page is left; of a page that was left nothing begins.
export async function whileHere<T>(work: (signal: AbortSignal) => Promise<T>, outer?: AbortSignal): Promise<T> {
  const own = new AbortController();
  const end = (): void => own.abort();
  underWay.add(own);
  outer?.addEventListener("abort", end);
  if (isAway || outer?.aborted) end();
  try {
    own.signal.throwIfAborted();
    return await work(own.signal);
  } finally {
    underWay.delete(own);
    outer?.removeEventListener("abort", end);
  }
}

export function leave(): void {
  isAway = true;
  for (const each of [...underWay]) each.abort();
  leavings.update((count) => count + 1);
}

export function comeBack(): void {
  isAway = false;
}

export function watchLeaving(): () => void {
  addEventListener("pagehide", leave);
  addEventListener("pageshow", comeBack);
  return () => {
    removeEventListener("pagehide", leave);
    removeEventListener("pageshow", comeBack);
  };
}
