// STOP is there once, whatever step or view one goes to while the stage moves.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { type SmallElement, drawn } from "./small_document.ts";

Object.defineProperty(globalThis, "location", { value: { hash: "", pathname: "/recipes", search: "?new" }, configurable: true });
const { loadTexts } = await import("../../../daemon/web/src/i18n/i18n.ts");
const { html } = await import("../../../daemon/web/src/lib/html.ts");
const { Assistant, kDraft } = await import("../../../daemon/web/src/pages/recipe/assistant/assistant.ts");
const { RecipeEditor } = await import("../../../daemon/web/src/pages/recipe/recipe_editor.ts");
const { keepDraft } = await import("../../../daemon/web/src/recipe/draft.ts");
const { session } = await import("../../../daemon/web/src/rpc/session.ts");

globalThis.fetch = (() => new Promise(() => undefined)) as unknown as typeof fetch;  // nothing needs an answer

const stops = (page: SmallElement): SmallElement[] => page.all("button").filter((each) => each.text === "STOP");

before(async () => {
  await loadTexts("en");
  session.set({ who: "me", role: "set_up" });
});

test("in every step of the assistant", () => {
  for (let step = 0; step < 7; ++step) {
    keepDraft(kDraft, { text: "{}", base_version: 0, step });
    const page = drawn(html`<${Assistant} taken=${[]}/>`);
    assert.match(page.all("h2")[0]?.text ?? "", new RegExp(`${step + 1} of 7`));
    assert.equal(stops(page).length, 1, `step ${step + 1}`);
  }
});

test("in every view of the editor", async () => {
  const page = drawn(html`<${RecipeEditor} id="groove" saved=${{ version: 1, text: "{}" }} draft=${null} onSaved=${() => undefined} onDiscard=${() => undefined}/>`);
  const views = page.all(".views")[0]?.all("button") ?? [];
  assert.equal(views.length, 5);
  for (const view of views) {
    view.listeners.get("click")?.call(view, { type: "click" });
    for (let i = 0; i < 5000 && view.given.get("aria-pressed") !== "true"; ++i) await new Promise((done) => setTimeout(done, 1));
    assert.equal(view.given.get("aria-pressed"), "true", view.text);
    assert.equal(stops(page).length, 1, view.text);
  }
});
