// Reads a stream of events by fetch: EventSource sends no Authorization, and where only a token says who somebody is
// it would be refused. A lost stream is opened again by itself, where it ended.
import { type SseEvent, SseParser } from "./sse.ts";

export interface EventReader {
  // Opens a new stream at once, as the one that calls now.
  restart(): void;
  // Waits no longer for the next attempt; leaves a stream alone.
  wake(): void;
  // Has no stream until it is restarted or woken.
  rest(): void;
  end(): void;
}

export interface EventReaderOptions {
  path: string;
  headers: () => Record<string, string>;  // of each request
  onOpen: () => void;
  onEvent: (event: SseEvent) => void;
  onRefused?: (status: number) => void;  // instead of a stream; onLost follows
  onLost: () => void;  // at each end and each attempt that failed
  silence_ms: number;  // a stream that says nothing for so long is lost
  retry_ms: number;    // until the stream says another time
  refused_ms: number;  // in its place after a refusal, unless that says another time
}

function refusalTime(response: Response, otherwise_ms: number): number {
  const asked_s = Number(response.headers.get("Retry-After") ?? Number.NaN);
  return Number.isFinite(asked_s) && asked_s >= 0 ? asked_s * 1000 : otherwise_ms;
}

export function readEvents(options: EventReaderOptions): EventReader {
  let { retry_ms } = options;
  let lastId = "";
  let attempt: AbortController | null = null;  // null: the next one is waited for
  let timer: ReturnType<typeof setTimeout> | undefined;
  let ended = false;

  const open = (): void => {
    clearTimeout(timer);
    attempt?.abort();
    if (ended) return;
    const mine = new AbortController();
    attempt = mine;
    heard(mine);
    read(mine).then((wait_ms) => lose(mine, wait_ms), () => lose(mine, retry_ms));
  };
  const lose = (mine: AbortController, wait_ms: number): void => {
    if (attempt !== mine) return;  // another one took its place
    clearTimeout(timer);
    attempt = null;
    mine.abort();
    timer = setTimeout(open, wait_ms);
    options.onLost();
  };
  // A machine that slept, or a cable that was pulled, leaves a stream that says nothing and does not end.
  const heard = (mine: AbortController): void => {
    clearTimeout(timer);
    timer = setTimeout(() => lose(mine, 0), options.silence_ms);
  };
  // How long to wait after it.
  const read = async (mine: AbortController): Promise<number> => {
    const response = await fetch(options.path, {
      headers: { Accept: "text/event-stream", ...options.headers(), ...(lastId === "" ? {} : { "Last-Event-ID": lastId }) },
      cache: "no-store",
      signal: mine.signal,
    });
    if (attempt !== mine) return 0;
    if (!response.ok) {
      options.onRefused?.(response.status);
      return refusalTime(response, options.refused_ms);
    }
    if (!response.body || !response.headers.get("Content-Type")?.startsWith("text/event-stream")) return options.refused_ms;
    const reader = response.body.getReader();
    const decoder = new TextDecoder();
    const parser = new SseParser(lastId);
    heard(mine);
    options.onOpen();
    for (;;) {
      const { done, value } = await reader.read();
      if (attempt !== mine) return 0;
      if (done) return retry_ms;
      heard(mine);
      const events = parser.take(decoder.decode(value, { stream: true }));
      retry_ms = parser.retry_ms ?? retry_ms;
      try {
        for (const event of events) options.onEvent(event);
      } catch (error) {
        console.error(error);
        lastId = "";  // everything is told anew
        return retry_ms;
      }
      lastId = parser.lastId;
    }
  };

  const rest = (): void => {
    clearTimeout(timer);
    const mine = attempt;
    attempt = null;
    mine?.abort();
  };

  open();
  return {
    restart: open,
    wake: () => {
      if (attempt === null) open();
    },
    rest,
    end: () => {
      ended = true;
      rest();
    },
  };
}
