import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";
import "./browser_stand_in.ts";

const kListeners = new Map<string, () => void>();
Object.assign(globalThis, { addEventListener: (name: string, call: () => void) => kListeners.set(name, call), removeEventListener: (name: string) => kListeners.delete(name) });
const { watchControl, giveControlBack, isHeldHere, renewalFault, takeControl } = await import("../../../daemon/web/src/rpc/held_control.ts");

const { session } = await import("../../../daemon/web/src/rpc/session.ts");
session.set({ who: "anna", role: "operate" });

const kRenew_ms = 20000;
let asked: string[] = [];
let refusal: { code: number; message: string; data: Record<string, unknown> } | null = null;

globalThis.fetch = (async (_address: unknown, init: { body: string }) => {
  const { id, method } = JSON.parse(init.body) as { id: number; method: string };
  asked.push(method);
  const answer = refusal ? { error: refusal } : { result: { owner: "page", who: "anna", remaining_s: 60, yours: true } };
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, ...answer }), { status: 200 });
}) as unknown as typeof fetch;

mock.timers.enable({ apis: ["setInterval"] });

// Answers are read in microtasks and turns of the loop, which the stopped clock does not hold up.
async function later(): Promise<void> {
  mock.timers.tick(kRenew_ms);
  for (let i = 0; i < 5; ++i) await new Promise((done) => setImmediate(done));
}

beforeEach(async () => {
  refusal = null;
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
