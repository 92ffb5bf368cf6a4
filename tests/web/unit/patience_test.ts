// Work that is given up in time, and leaves nothing behind.
import assert from "node:assert/strict";
import { getEventListeners } from "node:events";
import { afterEach, beforeEach, test } from "node:test";
import { letTimersGo, passTime, stopTimers, turns } from "./stopped_timers.ts";
import { pause, within } from "../../../daemon/web/src/lib/patience.ts";

// As a request: it ends with its signal, or when it is answered.
function request(): { work: (signal: AbortSignal) => Promise<string>; answer: (text: string) => void; fail: (error: Error) => void } {
  let answer = (_text: string): void => undefined;
  let fail = (_error: Error): void => undefined;
  return {
    work: (signal) => new Promise((resolve, reject) => {
      answer = resolve;
      fail = reject;
      const give = (): void => reject(new Error("given up"));
      if (signal.aborted) give();
      else signal.addEventListener("abort", give);
    }),
    answer: (text) => answer(text),
    fail: (error) => fail(error),
  };
}
const listeners = ({ signal }: AbortController): number => getEventListeners(signal, "abort").length;

beforeEach(stopTimers);
afterEach(letTimersGo);

test("work that lasts too long is given up, and not before", async () => {
  const { work } = request();
  let ended = false;
  const given = within(1000, work).finally(() => (ended = true));
  passTime(999);
  await turns();
  assert.equal(ended, false);
  passTime(1);
  await assert.rejects(given, /given up/);
});

test("whoever asked may give it up, also before it begins", async () => {
  const outer = new AbortController();
  const given = within(1000, request().work, outer.signal);
  outer.abort();
  await assert.rejects(given, /given up/);
  await assert.rejects(within(1000, request().work, outer.signal), /given up/);
});

test("what is answered in time is not given up afterwards, and its own errors are told", async () => {
  const { work, answer } = request();
  let own: AbortSignal | undefined;
  const given = within(1000, (signal) => work(own = signal));
  answer("here");
  assert.equal(await given, "here");
  passTime(5000);
  assert.equal(own?.aborted, false);
  const other = request();
  const failing = within(1000, other.work);
  other.fail(new Error("no such thing"));
  await assert.rejects(failing, /no such thing/);
});

test("no listener is left with the outer signal, whatever the end was", async () => {
  const outer = new AbortController();
  for (let i = 0; i < 20; ++i) {
    const { work, answer, fail } = request();
    const given = within(1000, work, outer.signal).catch(() => "failed");
    assert.equal(listeners(outer), 1);
    if (i % 3 === 0) answer("here");
    else if (i % 3 === 1) fail(new Error("no"));
    else passTime(1000);
    await given;
    assert.equal(listeners(outer), 0);
  }
});

test("a pause ends by its time or by its signal, and leaves no listener", async () => {
  const outer = new AbortController();
  const slept = pause(500, outer.signal);
  assert.equal(listeners(outer), 1);
  passTime(500);
  await slept;
  assert.equal(listeners(outer), 0);
  const cut = pause(1e6, outer.signal);
  outer.abort();
  await cut;
  assert.equal(listeners(outer), 0);
  const late = pause(1e6, outer.signal);
  passTime(0);
  await late;
});
