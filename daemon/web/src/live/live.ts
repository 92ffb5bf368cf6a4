// What the daemon is doing, as the stream of events tells it. One stream a tab; a lost one is opened again by itself.
import { createStore } from "../lib/store.ts";
import type { Alarm } from "../rpc/listed.ts";
import type { Methods } from "../rpc/methods.ts";

// A topic is told in full: keys that short replies leave out are there.
export type Full<M extends keyof Methods> = Required<Omit<Methods[M]["result"], "left_out">>;

export interface Topics {
  state: Full<"system.state"> | null;
  job: Full<"job.status"> | null;  // the running or the latest job
  control: Methods["control.state"]["result"] | null;
  health: Methods["system.health"]["result"] | null;
  alarms: Alarm[];
}

export interface Link {
  // lost: the stream is gone and is being sought; never: it was not there yet.
  status: "never" | "open" | "lost";
  since_ms: number;  // of performance.now()
}

const kSilence_ms = 40000;  // the daemon pings every 15 s
const kRetry_ms = 1000;

export const topics = createStore<Topics>({ state: null, job: null, control: null, health: null, alarms: [] });
export const link = createStore<Link>({ status: "never", since_ms: performance.now() });
// Counts results that became valid while the page looked on: who shows them fetches the newest.
export const results = createStore<{ count: number; job_id: string | null }>({ count: 0, job_id: null });
// Counts pictures of the daemon's starts and overruns after which everything was told anew.
export const resyncs = createStore(0);

function setStatus(status: Link["status"]): void {
  if (link.get().status !== status) link.set({ status, since_ms: performance.now() });
}

function take(name: keyof Topics, text: string): void {
  const value = JSON.parse(text) as never;
  topics.update((all) => ({ ...all, [name]: value }));
}

const kTopics: readonly (keyof Topics)[] = ["state", "job", "control", "health", "alarms"];

// Begins to listen; call the result to end it.
export function listen(): () => void {
  let source: EventSource | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let ended = false;

  const open = (): void => {
    if (ended) return;
    source = new EventSource("/api/v1/events");
    heard();
    source.onopen = () => heard();
    source.onerror = () => {
      setStatus("lost");
      // A browser gives up for good after an answer that is no stream; we do not.
      if (source?.readyState === EventSource.CLOSED) again(kRetry_ms);
    };
    source.addEventListener("ping", heard);
    source.addEventListener("snapshot", (event) => {
      heard();
      topics.set(JSON.parse(event.data) as Topics);
      setStatus("open");
    });
    source.addEventListener("resync", () => resyncs.update((count) => count + 1));
    for (const name of kTopics) {
      source.addEventListener(name, (event) => {
        heard();
        take(name, (event as MessageEvent<string>).data);
      });
    }
    source.addEventListener("result", (event) => {
      heard();
      const { job_id } = JSON.parse(event.data) as { job_id: string };
      results.update(({ count }) => ({ count: count + 1, job_id }));
    });
  };
  const again = (wait_ms: number): void => {
    clearTimeout(timer);
    source?.close();
    timer = setTimeout(open, wait_ms);
  };
  // A machine that slept, or a cable that was pulled, leaves a stream that says nothing and does not end.
  const heard = (): void => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      setStatus("lost");
      again(0);
    }, kSilence_ms);
    if (source?.readyState === EventSource.OPEN) setStatus("open");
  };
  const wake = (): void => {
    if (document.visibilityState === "visible" && source?.readyState === EventSource.CLOSED) again(0);
  };
  document.addEventListener("visibilitychange", wake);
  open();
  return () => {
    ended = true;
    clearTimeout(timer);
    document.removeEventListener("visibilitychange", wake);
    source?.close();
  };
}
