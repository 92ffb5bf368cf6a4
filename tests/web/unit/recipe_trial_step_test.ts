// The assistant's trial: what its buttons send and write, and when they may be pressed.
import assert from "node:assert/strict";
import { before, beforeEach, test } from "node:test";
import { type SmallElement, drawn } from "./small_document.ts";
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { TrialStep } from "../../../daemon/web/src/pages/recipe/assistant/trial_step.ts";
import type { JsonObject } from "../../../daemon/web/src/recipe/schema.ts";
import { session } from "../../../daemon/web/src/rpc/session.ts";
import { stopStage } from "../../../daemon/web/src/rpc/stop_stage.ts";

interface Asked { method: string; params: Record<string, unknown> }
let asked: Asked[] = [];
let answers: Record<string, unknown> = {};
let held: (() => void)[] = [];  // answers of recipe.save that a test keeps back
let isHeld = false;

globalThis.fetch = ((_address: unknown, { body }: { body: string }) => new Promise((resolve) => {
  const { id, method, params } = JSON.parse(body) as { id: number } & Asked;
  asked.push({ method, params });
  const said = method in answers ? { result: answers[method] } : { error: { code: 1005, message: `no ${method}`, data: { error: "unknown_recipe" } } };
  const answer = (): void => resolve(new Response(JSON.stringify({ jsonrpc: "2.0", id, ...said }), { status: 200 }));
  if (isHeld && method === "recipe.save") held.push(answer);
  else setImmediate(answer);  // in a turn of its own, as from a network: what asks again and again leaves turns to others
})) as unknown as typeof fetch;

const of = (method: string): Record<string, unknown>[] => asked.filter((each) => each.method === method).map(({ params }) => params);
async function until(holds: () => boolean, what: string): Promise<void> {
  for (let i = 0; i < 5000; ++i) {
    if (holds()) return;
    await new Promise((done) => setTimeout(done, 1));
  }
  assert.fail(what);
}

const kText = '{"format": 2}';
let written: unknown[] = [];
let chosen: string[] = [];
function step({ accepted = true, isChecked = true, result = null as JsonObject | null } = {}): SmallElement {
  const editor = { id: "new", text: kText, document: { reconstruct: { focus: { window_px: 9 } } }, check: { accepted }, isChecked, set: (...change: unknown[]) => written.push(change) };
  const newest = { job_id: result ? "J1" : "", recipe: "", result, problem: "", choose: (id: string) => chosen.push(id) };
  return drawn(html`<${TrialStep} editor=${editor} newest=${newest} taken=${[]}/>`);
}
const button = (page: SmallElement, text: string | RegExp): SmallElement =>
  page.all("button").find((each) => (typeof text === "string" ? each.text === text : text.test(each.text))) ?? assert.fail(`no button ${text} in: ${page.text}`);
const press = (element: SmallElement): void => {
  assert.equal(element.given.has("disabled"), false, `${element.text} may be pressed`);
  element.listeners.get("click")?.call(element, { type: "click" });
};
const kScan = "Scan";

before(() => loadTexts("en"));
beforeEach(() => {
  asked = [];
  written = [];
  chosen = [];
  held = [];
  isHeld = false;
  session.set({ who: "me", role: "set_up" });
  answers = {
    "recipe.save": { version: 1 }, "job.latest": { newest_seq: 6 }, "job.start": { job_id: "J7" }, "job.wait": { progress: 1, done: true, state: "completed" },
    "result.ack": {}, "result.get": { result: { verdict: null } }, "stage.stop": { stopped: "nothing", standstill: true }, "job.abort": {},
  };
});

test("a press keeps the draft, scans by it, and shows that job", async () => {
  const page = step();
  press(button(page, kScan));
  await until(() => chosen.length > 0, "the job is shown");
  assert.deepEqual(of("recipe.save"), [{ id: "try_new", text: kText, base_version: 0, author: "me", comment: "to try it" }]);
  assert.deepEqual(of("job.start"), [{ seq: 7, part_id: "trial", recipe: "try_new", client: "page" }]);
  assert.deepEqual(chosen, ["J7"]);
  await until(() => !button(page, kScan).given.has("disabled"), "it may be pressed again");
});

test("while it scans it is not pressed twice, and how far it is is told", async () => {
  answers["job.wait"] = { progress: 0.4, done: false };
  const page = step();
  press(button(page, kScan));
  await until(() => page.text.includes("40"), "it tells how far it is");
  assert.equal(button(page, kScan).given.has("disabled"), true);
  answers["job.wait"] = { progress: 1, done: true, state: "completed" };
  await until(() => chosen.length > 0, "it ends");
  assert.equal(of("job.start").length, 1);
});

test("a stop while the draft is being kept leaves the part where it is", async () => {
  isHeld = true;
  const page = step();
  press(button(page, kScan));
  await until(() => held.length === 1, "the draft is being kept");
  await stopStage();
  for (const answer of held) answer();
  await until(() => page.all(".problem").length > 0, "it says that nothing was moved");
  assert.equal(of("job.start").length, 0);
  assert.deepEqual(chosen, []);
});

test("a scan that failed says why, and shows no job", async () => {
  answers["job.wait"] = { progress: 0.1, done: true, state: "failed", error: "stage_lost", error_message: "the stage is gone" };
  const page = step();
  press(button(page, kScan));
  await until(() => /the stage is gone/.test(page.text), "the reason is there");
  assert.deepEqual(chosen, []);
});

test("it is not pressed by who may not set up, nor for a draft that is refused or not looked at yet", () => {
  for (const page of [step({ accepted: false }), step({ isChecked: false })]) assert.equal(button(page, kScan).given.has("disabled"), true);
  session.set({ who: "me", role: "operate" });
  assert.equal(button(step(), kScan).given.has("disabled"), true);
});

test("the window that the trial suggests is written when it is taken", () => {
  const values = (valid_fraction: number): JsonObject => ({ values: { valid_fraction, height: { min_um: 1, max_um: 2 }, sigma_median_um: 0.1 } });
  const page = step({ result: values(0.3) });
  assert.deepEqual(written, []);
  const take = button(page, /^Take \d+ px$/);
  press(take);
  assert.deepEqual(written, [[["reconstruct", "focus", "window_px"], Number(take.text.replace(/\D/g, ""))]]);
  assert.equal(step({ result: values(1) }).all("button").length, 1, "where the window is good there is nothing to take");
});
