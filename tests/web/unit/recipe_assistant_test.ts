// What the assistant writes into a new recipe by itself, and what it leaves to people.
import assert from "node:assert/strict";
import { before, beforeEach, test } from "node:test";
import type { VNode } from "preact";
import { type SmallElement, drawn } from "./small_document.ts";

const { html } = await import("../../../daemon/web/src/lib/html.ts");
const { loadTexts, setLanguage } = await import("../../../daemon/web/src/i18n/i18n.ts");
const { session } = await import("../../../daemon/web/src/rpc/session.ts");
const { PictureStep } = await import("../../../daemon/web/src/pages/recipe/assistant/picture_step.ts");
const { FocusStep } = await import("../../../daemon/web/src/pages/recipe/assistant/focus_step.ts");
const { keepDraft, readDraft } = await import("../../../daemon/web/src/recipe/draft.ts");

let asked: string[] = [];
let answers: Record<string, unknown> = {};
let written: unknown[] = [];
const editor = { document: { acquire: { camera: { exposure_us: 5000 } } }, problems: [], set: (...change: unknown[]) => { written.push(change); }, remove: () => undefined };

globalThis.fetch = (async (_address: unknown, about?: { body?: string }) => {
  const { id, method } = JSON.parse(about?.body ?? "{}") as { id: number; method: string };
  asked.push(method);
  const answer = answers[method];
  const said = answer instanceof Error ? { error: { code: 1113, message: "the stage has no reference", data: { error: answer.message } } } : { result: answer };
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, ...said }), { status: 200 });
}) as unknown as typeof fetch;

const button = (page: SmallElement, text: string): SmallElement | undefined => page.all("button").find((each) => each.text === text);
const press = (page: SmallElement, text: string): void => {
  const found = button(page, text) ?? assert.fail(`no button ${text} in: ${page.text}`);
  const listener = [...found.listeners].find(([name]) => name.toLowerCase() === "click")?.[1] ?? assert.fail(text);
  listener.call(found, { type: "click" });
};
// Answers and drawings come in turns of their own.
async function until(holds: () => boolean, what: string): Promise<void> {
  for (let i = 0; i < 200; ++i) {
    if (holds()) return;
    await new Promise((resolve) => setImmediate(resolve));
  }
  assert.fail(what);
}

before(async () => {
  await loadTexts("en");
  await setLanguage("en");
});

beforeEach(() => {
  asked = [];
  written = [];
  session.set({ who: "me", role: "set_up" });
});

test("an exposure that did not reach the brightness is written when it is taken, not before", async () => {
  answers = { "camera.suggest_exposure": { exposure_us: 52000, reached: false, looks: 8, grey: {} } };
  const page = drawn(html`<${PictureStep} editor=${editor}/>` as VNode);
  press(page, "Suggest the exposure");
  await until(() => page.text.includes("52000") || page.text.includes("52,000"), "it is shown");
  assert.deepEqual(written, []);
  press(page, page.all("button").find((each) => each.text.startsWith("Take"))?.text ?? "Take");
  assert.deepEqual(written, [[["acquire", "camera", "exposure_us"], 52000]]);
});

test("one that reached it is written at once", async () => {
  answers = { "camera.suggest_exposure": { exposure_us: 7300, reached: true, looks: 3, grey: {} } };
  press(drawn(html`<${PictureStep} editor=${editor}/>` as VNode), "Suggest the exposure");
  await until(() => written.length > 0, "it is written");
  assert.deepEqual(written, [[["acquire", "camera", "exposure_us"], 7300]]);
});

test("a stage without its reference is led to it where the focus is sought", async () => {
  answers = { "stage.autofocus": new Error("stage_not_homed"), "stage.home": { z_um: 0, homed: true } };
  const page = drawn(html`<${FocusStep} editor=${editor}/>` as VNode);
  assert.equal(button(page, "Find the reference"), undefined);
  press(page, "Seek the focus");
  await until(() => button(page, "Find the reference") !== undefined, "the button is there");
  assert.doesNotMatch(page.text, /stage\.home/);
  press(page, "Find the reference");
  await until(() => page.text.includes("has found its reference"), "it says so");
  assert.ok(asked.includes("stage.home"));
  assert.equal(button(page, "Find the reference"), undefined);
});

test("the step at which a new recipe was left is kept with its draft", () => {
  keepDraft("new", { text: "{}", base_version: 0, step: 4 });
  assert.equal(readDraft("new")?.step, 4);
});
