// Work that is given up: by whoever asked for it, or because it lasts too long. AbortSignal.any and AbortSignal.timeout
// would do it, but browsers of 2022 lack them, and each use leaves a listener with the signal that lives longer.

// The work's signal ends with the outer one, or after the time; nothing of it is left when the work has ended.
export async function within<T>(patience_ms: number, work: (signal: AbortSignal) => Promise<T>, outer?: AbortSignal): Promise<T> {
  const own = new AbortController();
  const end = (): void => own.abort();
  const timer = setTimeout(end, patience_ms);
  outer?.addEventListener("abort", end);
  if (outer?.aborted) end();
  try {
    return await work(own.signal);
  } finally {
    clearTimeout(timer);
    outer?.removeEventListener("abort", end);
  }
}

// Waits; not any longer once the signal ends.
export function pause(wait_ms: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const done = (): void => {
      clearTimeout(timer);
      signal.removeEventListener("abort", done);
      resolve();
    };
    const timer = setTimeout(done, signal.aborted ? 0 : wait_ms);
    signal.addEventListener("abort", done);
  });
}
