// What the daemon is doing, as the stream of events tells it. One stream a tab; a lost one is opened again by itself.
import { createStore } from "../lib/store.ts";
import { onWake } from "../lib/wake.ts";
import type { Alarm } from "../rpc/listed.ts";
import type { Methods } from "../rpc/methods.ts";
import { headers, refuseToken, token } from "../rpc/rpc.ts";
import { readEvents } from "./event_reader.ts";
import type { SseEvent } from "./sse.ts";

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
const kRefused_ms = 5000;  // who may not look is told so in the daemon's log each time

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

function takeEvent({ name, data }: SseEvent): void {
  if (name === "snapshot") {
    topics.set(JSON.parse(data) as Topics);
  } else if (name === "resync") {
    resyncs.update((count) => count + 1);
  } else if (name === "result") {
    const { job_id } = JSON.parse(data) as { job_id: string };
    results.update(({ count }) => ({ count: count + 1, job_id }));
  } else if ((kTopics as readonly string[]).includes(name)) {
    take(name as keyof Topics, data);
  }
}

// Begins to listen; call the result to end it.
export function listen(): () => void {
  let given: string | null = null;
  const reader = readEvents({
    path: "/api/v1/events",
    headers: () => {
      given = token.get();
      return headers();
    },
    onRefused: (status) => {
      if (status === 401) refuseToken(given);
    },
    onOpen: () => setStatus("open"),
    onEvent: takeEvent,
    onLost: () => setStatus("lost"),
    silence_ms: kSilence_ms,
    retry_ms: kRetry_ms,
    refused_ms: kRefused_ms,
  });
  // Somebody else looks on from now on, or nobody.
  const unwatch = token.watch(() => reader.restart());
  const wake = (): void => {
    if (document.visibilityState === "visible") reader.wake();
  };
  document.addEventListener("visibilitychange", wake);
  addEventListener("online", wake);
  // What was told before a sleep may be hours old, and the stream dead: it is said so until there is another one.
  const anew = (): void => {
    setStatus("lost");
    reader.restart();
  };
  const unsleep = onWake(anew);
  // In the browser's memory of pages a stream does not live on, but would keep its connection from the next page.
  const hide = (): void => reader.rest();
  addEventListener("pagehide", hide);
  const show = (event: PageTransitionEvent): void => {
    if (event.persisted) anew();
  };
  addEventListener("pageshow", show);
  return () => {
    unwatch();
    unsleep();
    document.removeEventListener("visibilitychange", wake);
    removeEventListener("online", wake);
    removeEventListener("pagehide", hide);
    removeEventListener("pageshow", show);
    reader.end();
  };
}
