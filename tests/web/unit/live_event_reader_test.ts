import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { type EventReader, type EventReaderOptions, readEvents } from "../../../daemon/web/src/live/event_reader.ts";

interface Asked {
  headers: Record<string, string>;
  signal: AbortSignal;
  // Of the answer that it was given.
  send: (text: string) => void;
  close: () => void;
  fail: () => void;
}

let asked: Asked[] = [];
let heard: string[] = [];
let refusals: Response[] = [];  // answered before there is a stream
let reader: EventReader | null = null;
let token: string | null = null;

globalThis.fetch = (async (_address: unknown, init: { headers: Record<string, string>; signal: AbortSignal }) => {
  let source!: ReadableStreamDefaultController<Uint8Array>;
  const body = new ReadableStream<Uint8Array>({ start: (controller) => void (source = controller) });
  init.signal.addEventListener("abort", () => {
    try {
      source.error(new Error("aborted"));
    } catch {
      // It has ended.
    }
  });
  asked.push({
    headers: init.headers,
    signal: init.signal,
    send: (text) => source.enqueue(new TextEncoder().encode(text)),
    close: () => source.close(),
    fail: () => source.error(new Error("the cable was pulled")),
  });
  return refusals.shift() ?? new Response(body, { status: 200, headers: { "Content-Type": "text/event-stream" } });
}) as unknown as typeof fetch;

// Waits for what timers and streams bring; there is no end but the runner's.
async function until(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise((done) => setImmediate(done));
}
const count = (what: string): number => heard.filter((each) => each === what).length;

function read(more: Partial<EventReaderOptions> = {}): void {
  reader = readEvents({
    path: "/events",
    headers: () => (token === null ? {} : { Authorization: `Bearer ${token}` }),
    onOpen: () => heard.push("open"),
    onEvent: ({ name, data }) => heard.push(`${name} ${data}`),
    onLost: () => heard.push("lost"),
    silence_ms: 1e6,
    retry_ms: 1,
    refused_ms: 1e6,
    ...more,
  });
}

beforeEach(() => {
  asked = [];
  heard = [];
  refusals = [];
  token = null;
});
afterEach(() => reader?.end());

test("a stream is asked for with the token, and its events are told", async () => {
  token = "secret";
  read();
  assert.equal(asked[0]?.headers["Authorization"], "Bearer secret");
  assert.equal(asked[0]?.headers["Last-Event-ID"], undefined);
  asked[0]?.send("id: 17-1\nevent: state\ndata: 1\n\n");
  await until(() => heard.length === 2);
  assert.deepEqual(heard, ["open", "state 1"]);
});

test("a stream that ended or broke goes on where it was", async () => {
  read();
  asked[0]?.send("id: 17-1\nevent: state\ndata: 1\n\nid: 17-2\nevent: state\n");
  await until(() => count("state 1") === 1);
  asked[0]?.close();
  await until(() => asked.length === 2);
  assert.equal(asked[1]?.headers["Last-Event-ID"], "17-1", "the second was not whole");
  asked[1]?.fail();
  await until(() => asked.length === 3);
  assert.equal(asked[2]?.headers["Last-Event-ID"], "17-1");
  assert.equal(count("lost"), 2);
});

test("the stream says when to come again", async () => {
  read({ retry_ms: 1 });
  asked[0]?.send("retry: 1000000\n\nevent: state\ndata: 1\n\n");
  await until(() => count("state 1") === 1);
  asked[0]?.close();
  await until(() => count("lost") === 1);
  reader?.wake();
  assert.equal(asked.length, 2, "it was waiting");
  reader?.wake();
  assert.equal(asked.length, 2, "it is being asked");
});

test("a refusal is no stream, and says how long to wait", async () => {
  refusals = [new Response("{}", { status: 403 })];
  read();
  await until(() => count("lost") === 1);
  assert.equal(count("open"), 0);
  refusals = [
    new Response("{}", { status: 503, headers: { "Retry-After": "0" } }),
    new Response("<html>", { status: 200, headers: { "Content-Type": "text/html" } }),
  ];
  reader?.wake();
  await until(() => count("lost") === 3);
  assert.equal(asked.length, 3, "the second came by itself");
  assert.equal(count("open"), 0);
});

test("a refusal is told with its status, before the stream counts as lost", async () => {
  refusals = [new Response("{}", { status: 401 })];
  read({ onRefused: (status) => heard.push(`refused ${status}`) });
  await until(() => count("lost") === 1);
  assert.deepEqual(heard, ["refused 401", "lost"]);
});

test("who asks anew at a refusal is not made to wait for it", async () => {
  refusals = [new Response("{}", { status: 401 })];
  token = "wrong";
  read({
    onRefused: () => {
      token = null;
      reader?.restart();
    },
  });
  await until(() => count("open") === 1);
  assert.equal(asked.length, 2);
  assert.equal(asked[1]?.headers["Authorization"], undefined);
  assert.equal(count("lost"), 0);
});

test("another token begins another stream", async () => {
  read();
  asked[0]?.send("id: 17-1\nevent: state\ndata: 1\n\n");
  await until(() => count("state 1") === 1);
  token = "secret";
  reader?.restart();
  assert.equal(asked[0]?.signal.aborted, true);
  assert.equal(asked[1]?.headers["Authorization"], "Bearer secret");
  assert.equal(asked[1]?.headers["Last-Event-ID"], "17-1");
  await until(() => count("open") === 2);
  assert.equal(count("lost"), 0);
});

test("silence is a loss", async () => {
  read({ silence_ms: 1 });
  await until(() => asked.length >= 3);
  assert.equal(asked[0]?.signal.aborted, true);
  assert.ok(count("lost") >= 2);
});

test("an event that cannot be taken makes everything be told anew", async () => {
  const told = console.error;
  console.error = () => undefined;
  let fails = true;
  read({
    onEvent: () => {
      if (fails) throw new Error("a bug");
      heard.push("taken");
    },
  });
  asked[0]?.send("id: 17-1\nevent: state\ndata: 1\n\n");
  await until(() => asked.length === 2);
  console.error = told;
  fails = false;
  assert.equal(asked[1]?.headers["Last-Event-ID"], undefined);
  asked[1]?.send("event: snapshot\ndata: 1\n\n");
  await until(() => count("taken") === 1);
});

test("its end is the end", async () => {
  read();
  await until(() => count("open") === 1);
  reader?.end();
  reader?.wake();
  reader?.restart();
  assert.equal(asked.length, 1);
  assert.equal(asked[0]?.signal.aborted, true);
  assert.equal(count("lost"), 0);
});

test("at rest there is no stream, and it is no loss; afterwards it goes on where it was", async () => {
  read();
  asked[0]?.send("id: 17-1\nevent: state\ndata: 1\n\n");
  await until(() => count("state 1") === 1);
  reader?.rest();
  assert.equal(asked[0]?.signal.aborted, true);
  await new Promise((done) => setImmediate(done));
  assert.equal(asked.length, 1);
  assert.equal(count("lost"), 0);
  reader?.restart();
  assert.equal(asked[1]?.headers["Last-Event-ID"], "17-1");
  await until(() => count("open") === 2);
});
