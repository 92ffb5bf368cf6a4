// The live picture is asked for as long as somebody looks, and the asking leaves nothing behind.
import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import "./browser_stand_in.ts";
import { letTimersGo, passTime, stopTimers, turns } from "./stopped_timers.ts";

const { watchPreview } = await import("../../../daemon/web/src/run/preview_poll.ts");

let asked: { signal: AbortSignal; answer: (status: number) => void }[] = [];
let told: string[] = [];
const held = new Map<AbortSignal, number>();  // listeners, added less removed

Object.assign(globalThis.document, { visibilityState: "visible" });
for (const [name, by] of [["addEventListener", 1], ["removeEventListener", -1]] as const) {
  const own = EventTarget.prototype[name];
  Object.defineProperty(AbortSignal.prototype, name, {
    value: function (this: AbortSignal, ...given: Parameters<typeof own>) {
      held.set(this, (held.get(this) ?? 0) + by);
      own.apply(this, given);
    },
  });
}
globalThis.fetch = ((_address: unknown, { signal }: { signal: AbortSignal }) => new Promise((resolve, reject) => {
  signal.onabort = () => reject(new Error("given up"));
  asked.push({ signal, answer: (status) => resolve(new Response(null, { status })) });
})) as unknown as typeof fetch;

beforeEach(() => {
  asked = [];
  told = [];
  held.clear();
  stopTimers();
});
afterEach(letTimersGo);

// Those with the signal that lives as long as somebody looks; requests have signals of their own.
const heldByAll = (): number => [...held].filter(([signal]) => !asked.some((each) => each.signal === signal)).reduce((sum, [, count]) => sum + count, 0);

test("a hundred requests leave no more listeners than one", async () => {
  const end = watchPreview(() => undefined, (status) => told.push(status));
  const ofOne = heldByAll();
  assert.ok(ofOne > 0);
  for (let i = 0; i < 100; ++i) {
    asked.at(-1)?.answer(204);
    await turns();
    passTime(500);
    await turns();
  }
  assert.equal(asked.length, 101);
  assert.equal(heldByAll(), ofOne);
  end();
  await turns();
  assert.equal(heldByAll(), 0);
});

test("a request that is not answered is given up after twenty seconds, and another one begins", async () => {
  const end = watchPreview(() => undefined, (status) => told.push(status));
  passTime(19999);
  await turns();
  assert.deepEqual([asked.length, told.length], [1, 0]);
  passTime(1);
  await turns();
  assert.equal(asked[0]?.signal.aborted, true);
  assert.deepEqual(told, ["offline"]);
  passTime(1000);
  await turns();
  assert.equal(asked.length, 2);
  end();
});

test("its end gives up the request that is under way, and nothing is told or asked any more", async () => {
  const end = watchPreview(() => undefined, (status) => told.push(status));
  end();
  await turns();
  assert.equal(asked[0]?.signal.aborted, true);
  passTime(60000);
  await turns();
  assert.deepEqual([asked.length, told.length], [1, 0]);
});
