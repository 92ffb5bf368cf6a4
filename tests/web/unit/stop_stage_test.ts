// STOP: each press is sent, and what was pressed before it and waits in the tab is not sent after it.
import assert from "node:assert/strict";
import { afterEach, before, beforeEach, test } from "node:test";
import { type SmallElement, drawn } from "./small_document.ts";
import { letTimersGo, passTime, stopTimers, turns } from "./stopped_timers.ts";
import { asCommand, asPicture } from "../../../daemon/web/src/camera/devices_turn.ts";
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { link } from "../../../daemon/web/src/live/live.ts";
import { askNewest, home, start, stop } from "../../../daemon/web/src/pages/run/commands.ts";
import { ControlStrip } from "../../../daemon/web/src/pages/setup/control_strip.ts";
import { pressed, scanBy } from "../../../daemon/web/src/recipe/try_recipe.ts";
import { call, kOffline } from "../../../daemon/web/src/rpc/rpc.ts";
import { type Role, session } from "../../../daemon/web/src/rpc/session.ts";
import { stopStage } from "../../../daemon/web/src/rpc/stop_stage.ts";

interface Asked { method: string; params: Record<string, unknown>; answer: (result: unknown) => void }
let asked: Asked[] = [];
let answers: Record<string, unknown> = {};

// A daemon that answers some methods at once and the others when it is told to, or never.
globalThis.fetch = ((_address: unknown, { body, signal }: { body: string; signal?: AbortSignal }) => new Promise((resolve, reject) => {
  const { id, method, params } = JSON.parse(body) as { id: number; method: string; params: Record<string, unknown> };
  const answer = (result: unknown): void => resolve(new Response(JSON.stringify({ jsonrpc: "2.0", id, result }), { status: 200 }));
  asked.push({ method, params, answer });
  signal?.addEventListener("abort", () => reject(new Error("given up")));
  if (method in answers) answer(answers[method]);
})) as unknown as typeof fetch;

const of = (method: string): Asked[] => asked.filter((each) => each.method === method);
// Also where what was sent never comes: then the test fails.
async function sent(method: string, count = 1): Promise<void> {
  for (let i = 0; i < 20000 && of(method).length < count; ++i) await turns();
  assert.ok(of(method).length >= count, `${method} was not sent`);
}
const kStopped = { stopped: "nothing", standstill: true };
const kStarted = { job_id: "J2", seq: 2, client: "page", duplicate: false, state: "processing" };

before(() => loadTexts("en"));
beforeEach(() => {
  asked = [];
  answers = {};
  session.set({ who: "anna", role: "operate" });
});
afterEach(letTimersGo);

test("a motion that waits for a picture is not begun after a stop", async () => {
  let isTaken = (): void => undefined;
  const picture = asPicture(() => new Promise<void>((done) => (isTaken = done)));
  await turns();
  let moves = 0;
  const moved = asCommand(async () => void ++moves);
  const given = assert.rejects(moved, { error: "aborted" });
  answers = { "stage.stop": kStopped };
  await stopStage();
  isTaken();
  await picture;
  await given;
  assert.equal(moves, 0);
  await asCommand(async () => void ++moves);
  assert.equal(moves, 1, "what is pressed after the stop begins");
});

test("nor one that waited for very long, as in a sleep", async () => {
  const now = Date.now;
  let moves = 0;
  let isTaken = (): void => undefined;
  const picture = asPicture(() => new Promise<void>((done) => (isTaken = done)));
  await turns();
  try {
    const given = assert.rejects(asCommand(async () => void ++moves), { error: "aborted" });
    Date.now = () => now() + 3600000;
    isTaken();
    await picture;
    await given;
  } finally {
    Date.now = now;
  }
  assert.equal(moves, 0);
});

// The daemon has the stop before the motion that was sent before it.
async function overtaken(motion: () => Promise<unknown>, method: string): Promise<void> {
  stopTimers();
  asked = [];
  answers = { "stage.stop": kStopped };
  const moved = motion().catch(() => undefined);
  await sent(method);
  await stopStage();
  assert.equal(of("stage.stop").length, 1);
  passTime(1000);
  await turns();
  assert.equal(of("stage.stop").length, 2, `${method} may have come after the stop`);
  answers["stage.stop"] = { ...kStopped, stopped: "command" };
  passTime(1000);
  await turns();
  assert.equal(of("stage.stop").length, 3);
  of(method)[0]?.answer({ z_um: 0, homed: true });
  await moved;
  passTime(60000);
  await turns();
  assert.equal(of("stage.stop").length, 3, "what was found needs no further stop");
}

test("a motion that was overtaken by a stop on its way is stopped again", async () => {
  await overtaken(() => asCommand(() => call("stage.home", {})), "stage.home");
  await overtaken(() => asCommand(() => call("stage.autofocus", { from_um: 0, to_um: 9 })), "stage.autofocus");
  await overtaken(home, "stage.home");
});

test("nothing is stopped by itself once the motion was answered, nor what is pressed after the stop", async () => {
  stopTimers();
  answers = { "stage.stop": kStopped };
  const first = asCommand(() => call("stage.home", {}));
  await sent("stage.home");
  await stopStage();
  const second = asCommand(() => call("stage.move", { z_um: 5 }));
  of("stage.home")[0]?.answer({ z_um: 0, homed: true });
  await first;
  await sent("stage.move");
  passTime(60000);
  await turns();
  assert.equal(of("stage.stop").length, 1);
  of("stage.move")[0]?.answer({ z_um: 5 });
  await second;
});

test("a stop that is lost is sent again while the motion lasts, and not for ever", async () => {
  stopTimers();
  const moved = asCommand(() => call("stage.home", {}));
  await sent("stage.home");
  const lost = assert.rejects(stopStage(), { code: kOffline });
  passTime(5000);
  await lost;
  answers = { "stage.stop": kStopped };
  for (let i = 0; i < 200; ++i) {
    passTime(1000);
    await turns();
  }
  const all = of("stage.stop").length;
  assert.ok(all > 2 && all < 100, `${all}`);
  passTime(60000);
  await turns();
  assert.equal(of("stage.stop").length, all);
  of("stage.home")[0]?.answer({ z_um: 0, homed: true });
  await moved;
});

test("a stop that nobody answers ends, and another press does not wait for that", async () => {
  stopTimers();
  const first = stop();
  const second = stop();
  await turns();
  assert.equal(of("stage.stop").length, 2);
  of("stage.stop")[1]?.answer(kStopped);
  await second;
  passTime(5000);
  await first;
  const lost = assert.rejects(stopStage(), { code: kOffline });
  passTime(5000);
  await lost;
});

test("a stop is sent also while it is not known who this tab is, and not by who only looks", async () => {
  answers = { "stage.stop": kStopped };
  session.set({ who: "", role: "none" });
  await stop();
  assert.equal(of("stage.stop").length, 1);
  session.set({ who: "visitor", role: "view" });
  await stop();
  assert.equal(of("stage.stop").length, 1);
});

test("a job whose start was overtaken by a stop is ended", async () => {
  answers = { "stage.stop": kStopped, "job.latest": { newest_seq: 1 }, "job.abort": {} };
  const started = start("p", "r");
  await sent("job.start");
  await stopStage();
  of("job.start")[0]?.answer(kStarted);
  await started;
  assert.deepEqual(of("job.abort").map(({ params }) => params), [{ job_id: "J2" }]);
});

test("a start that asks for its number is not sent after a stop of the set-up page", async () => {
  answers = { "stage.stop": kStopped };
  askNewest();  // forgets the number, and is not answered
  await sent("job.latest");
  const started = start("p", "r");
  await stopStage();
  await sent("job.latest", 2);
  for (const { answer } of of("job.latest")) answer({ newest_seq: 1 });
  await started;
  assert.equal(of("job.start").length, 0);
});

test("nor is a trial scan; and one that was under way is ended", async () => {
  answers = { "stage.stop": kStopped, "job.abort": {}, "result.ack": {}, "job.wait": { done: true, state: "aborted" } };
  const waiting = assert.rejects(scanBy("r", "p", pressed(), () => undefined), { error: "aborted" });
  await stopStage();
  of("job.latest")[0]?.answer({ newest_seq: 1 });
  await waiting;
  assert.equal(of("job.start").length, 0);

  // Nor one whose draft was still being saved as STOP was pressed.
  const press = pressed();
  await stopStage();
  answers["job.latest"] = { newest_seq: 1 };
  await assert.rejects(scanBy("r", "p", press, () => undefined), { error: "aborted" });
  assert.equal(of("job.start").length, 0);

  const scanned = assert.rejects(scanBy("r", "p", pressed(), () => undefined));
  await sent("job.start");
  await stopStage();
  of("job.start")[0]?.answer(kStarted);
  await scanned;
  assert.deepEqual(of("job.abort").map(({ params }) => params), [{ job_id: "J2" }]);
});

test("STOP of the set-up page may be pressed while the stream of events is broken, by whoever may", async () => {
  answers = { "stage.stop": kStopped };
  link.update((all) => ({ ...all, status: "closed" as never }));
  const button = (role: Role): SmallElement | undefined => {
    session.set({ who: "anna", role });
    return drawn(html`<${ControlStrip}/>`).all("button").find((each) => each.given.get("class")?.includes("stop"));
  };
  const press = (element: SmallElement | undefined): void => element?.listeners.get("click")?.call(element, { type: "click" });
  const mine = button("operate");
  assert.equal(mine?.given.has("disabled"), false);
  press(mine);
  press(mine);
  await turns();
  assert.equal(of("stage.stop").length, 2);
  assert.equal(button("view")?.given.has("disabled"), true);
});
