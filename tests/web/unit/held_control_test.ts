import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import "./browser_stand_in.ts";
import { passTime, stopTimers, turns } from "./stopped_timers.ts";

const kListeners = new Map<string, () => void>();
Object.assign(globalThis, { addEventListener: (name: string, call: () => void) => kListeners.set(name, call), removeEventListener: (name: string) => kListeners.delete(name) });
const { watchControl, giveControlBack, isHeldHere, leaveControl, renewalFault, takeControl } = await import("../../../daemon/web/src/rpc/held_control.ts");

const { topics } = await import("../../../daemon/web/src/live/live.ts");
const { session } = await import("../../../daemon/web/src/rpc/session.ts");
session.set({ who: "anna", role: "operate" });

const kRenew_ms = 20000;
let asked: string[] = [];
let refusal: { code: number; message: string; data: Record<string, unknown> } | null = null;
// Acquisitions that the daemon takes its time for; null = it answers at once.
let slow: { answer: () => void; signal: AbortSignal }[] | null = null;

globalThis.fetch = (async (_address: unknown, init: { body: string; signal?: AbortSignal }) => {
  const { id, method } = JSON.parse(init.body) as { id: number; method: string };
  asked.push(method);
  const answer = refusal ? { error: refusal } : { result: { owner: method === "control.release" ? "" : "page", who: "anna", remaining_s: 60, yours: true } };
  const { signal } = init;
  if (slow && signal && method === "control.acquire") {
    await new Promise<void>((resolve, reject) => {
      slow?.push({ answer: resolve, signal });
      signal.addEventListener("abort", () => reject(new Error("given up")));
    });
  }
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, ...answer }), { status: 200 });
}) as unknown as typeof fetch;

stopTimers();

async function later(): Promise<void> {
  passTime(kRenew_ms);
  await turns();
}

beforeEach(async () => {
  refusal = null;
  slow = null;
  await giveControlBack();
  asked = [];
});

test("control is renewed until it is given back, on whichever page, and never after", async () => {
  await takeControl(false);
  await later();
  assert.deepEqual(asked, ["control.acquire", "control.acquire"]);
  await giveControlBack();
  await later();
  await later();
  assert.deepEqual(asked, ["control.acquire", "control.acquire", "control.release"]);
  assert.equal(isHeldHere.get(), false);
});

test("taking it twice renews it once", async () => {
  await takeControl(false);
  await takeControl(true);
  await later();
  assert.equal(asked.length, 3);
});

test("a renewal that is refused is the last one", async () => {
  await takeControl(false);
  refusal = { code: 1003, message: "somebody has control", data: { error: "no_control" } };
  await later();
  assert.equal(isHeldHere.get(), false);
  await later();
  assert.equal(asked.length, 2);
});

test("also where a press since then took nothing", async () => {
  await takeControl(false);
  refusal = { code: 1013, message: "the daemon ends", data: { error: "shutting_down" } };
  await assert.rejects(takeControl(true));
  assert.equal(isHeldHere.get(), true);
  await later();
  assert.notEqual(renewalFault.get(), null);
  refusal = { code: 1003, message: "somebody has control", data: { error: "no_control" } };
  await later();
  assert.equal(isHeldHere.get(), false);
});

test("a renewal that fails for another reason is told and tried again", async () => {
  await takeControl(false);
  refusal = { code: 1013, message: "the daemon ends", data: { error: "shutting_down" } };
  await later();
  assert.equal(isHeldHere.get(), true);
  assert.notEqual(renewalFault.get(), null);
  refusal = null;
  await later();
  assert.equal(renewalFault.get(), null);
  assert.equal(asked.length, 3);
});

test("a page that leaves gives control back, and does not renew it where the browser brings it back", async () => {
  const unwatch = watchControl();
  await takeControl(false);
  kListeners.get("pagehide")?.();
  assert.equal(isHeldHere.get(), false);
  await later();
  await later();
  assert.deepEqual(asked, ["control.acquire", "control.release"]);
  unwatch();
});

test("control that ran out in a sleep is not taken again without a press; a shorter one does not matter", async () => {
  const now = Date.now;
  const unwatch = watchControl();
  try {
    await takeControl(false);
    Date.now = () => now() + 30000;
    await later();
    assert.equal(isHeldHere.get(), true);
    Date.now = () => now() + 200000;
    await later();
    assert.equal(isHeldHere.get(), false);
    asked = [];
    await later();
    assert.deepEqual(asked, []);
  } finally {
    Date.now = now;
    unwatch();
  }
});

test("the first timer after a sleep does not renew control that ran out, whoever notices the sleep first", async () => {
  const now = Date.now;
  try {
    await takeControl(false);  // nothing else watches for a sleep here
    Date.now = () => now() + 60000;
    await later();
    assert.deepEqual(asked, ["control.acquire", "control.acquire"], "a hidden tab, whose timers come once a minute");
    Date.now = () => now() + 60000 + 70000;
    await later();
    assert.equal(isHeldHere.get(), false);
    assert.equal(asked.length, 2);
  } finally {
    Date.now = now;
  }
});

test("a renewal that is under way does not overtake the release, and its answer counts no more", async () => {
  await takeControl(false);
  slow = [];
  await later();
  const given = giveControlBack();
  await turns();
  assert.deepEqual(asked, ["control.acquire", "control.acquire"], "the release waits for what the daemon may yet deal with");
  assert.equal(isHeldHere.get(), false);
  slow[0]?.answer();
  await given;
  assert.deepEqual(asked, ["control.acquire", "control.acquire", "control.release"]);
  assert.equal(topics.get().control?.owner, "");
  assert.equal(isHeldHere.get(), false);
  await later();
  assert.equal(asked.length, 3);
});

test("a release waits no longer than two seconds for a renewal, which is given up then without a word", async () => {
  await takeControl(false);
  slow = [];
  await later();
  const given = giveControlBack();
  passTime(1999);
  await turns();
  assert.equal(slow[0]?.signal.aborted, false);
  passTime(1);
  await given;
  assert.equal(slow[0]?.signal.aborted, true);
  assert.equal(asked.at(-1), "control.release");
  assert.equal(renewalFault.get(), null);
});

test("taking that is given back before it is answered does not begin to renew", async () => {
  slow = [];
  const taken = takeControl(false);
  const given = giveControlBack();
  await turns();
  slow[0]?.answer();
  await Promise.all([taken, given]);
  assert.equal(isHeldHere.get(), false);
  await later();
  assert.deepEqual(asked, ["control.acquire", "control.release"]);
});

test("control that is taken again while the release waits is kept", async () => {
  await takeControl(false);
  slow = [];
  await later();
  const given = giveControlBack();
  const taken = takeControl(false);
  await turns();
  for (const { answer } of slow) answer();
  await Promise.all([given, taken]);
  assert.equal(isHeldHere.get(), true);
  assert.ok(!asked.includes("control.release"));
});

test("a renewal that is refused for what was before does not end what was taken since", async () => {
  await takeControl(false);
  slow = [];
  refusal = { code: 1003, message: "somebody has control", data: { error: "no_control" } };
  await later();  // its answer is already refused
  refusal = null;
  const forced = takeControl(true);
  await turns();
  slow[1]?.answer();
  await forced;
  slow[0]?.answer();
  await turns();
  assert.equal(isHeldHere.get(), true);
  assert.equal(renewalFault.get(), null);
});

test("a renewal that is never answered is told as one that failed, and the next one comes in its time", async () => {
  await takeControl(false);
  slow = [];
  await later();
  passTime(15000);
  await turns();
  assert.equal(slow[0]?.signal.aborted, true);
  assert.equal((renewalFault.get() as { error?: string } | null)?.error, "offline");
  assert.equal(isHeldHere.get(), true);
  slow = null;
  passTime(5000);
  await turns();
  assert.equal(renewalFault.get(), null);
});

test("who logs out leaves control at once, whatever is under way", async () => {
  await takeControl(false);
  slow = [];
  await later();
  leaveControl();
  assert.equal(asked.at(-1), "control.release");
  assert.equal(slow[0]?.signal.aborted, true);
  await turns();
  assert.equal(isHeldHere.get(), false);
  const before = asked.length;
  leaveControl();
  assert.equal(asked.length, before, "there is nothing to leave");
});
