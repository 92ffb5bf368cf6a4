// A recipe that was saved after the list was told is started by its name, and no other in its place.
import assert from "node:assert/strict";
import { test } from "node:test";
import { render } from "preact";
import { type SmallElement, drawn } from "./small_document.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { link } from "../../../daemon/web/src/live/live.ts";
import { recipes } from "../../../daemon/web/src/pages/run/run_state.ts";
import { recipeOf } from "../../../daemon/web/src/pages/run/use_machine.ts";
import { useRecipeList } from "../../../daemon/web/src/pages/run/use_recipe_list.ts";

let answers: ((known: string[]) => void)[] = [];
globalThis.fetch = ((_address: unknown, { body }: { body: string }) => new Promise((resolve) => {
  const { id } = JSON.parse(body) as { id: number };
  answers.push((known) => resolve(new Response(JSON.stringify({ jsonrpc: "2.0", id, result: { recipes: known } }), { status: 200 })));
})) as unknown as typeof fetch;

const Page = () => html`<p>${useRecipeList()}</p>`;
const leave = (page: SmallElement): void => render(null, page as unknown as Element);
// Effects come after a timer where there is no screen.
async function until(holds: () => boolean, what: string): Promise<void> {
  for (let i = 0; i < 5000; ++i) {
    if (holds()) return;
    await new Promise((done) => setTimeout(done, 1));
  }
  assert.fail(what);
}

test("from leaving the page until the list is told again, the choice counts as it is", async () => {
  link.update((now) => ({ ...now, status: "open" }));
  const first = drawn(html`<${Page}/>`);
  await until(() => answers.length === 1, "the list is asked for");
  answers[0]?.(["anvil", "groove"]);
  await until(() => recipes.get() !== null, "it is known");
  assert.equal(recipeOf("gone", recipes.get()), "anvil");
  leave(first);
  await until(() => recipes.get() === null, "it is forgotten with the page");
  assert.equal(recipeOf("just_saved", recipes.get()), "just_saved");

  const second = drawn(html`<${Page}/>`);
  await until(() => answers.length === 2, "it is asked for again");
  assert.equal(recipeOf("just_saved", recipes.get()), "just_saved");
  answers[1]?.(["anvil", "groove", "just_saved"]);
  await until(() => recipes.get() !== null, "it is known again");
  assert.equal(recipeOf("just_saved", recipes.get()), "just_saved");
  leave(second);
});

test("an answer that comes after the page was left is not kept", async () => {
  answers = [];
  const page = drawn(html`<${Page}/>`);
  await until(() => answers.length === 1, "the list is asked for");
  recipes.set(["groove"]);
  leave(page);
  await until(() => recipes.get() === null, "what was known is forgotten");
  answers[0]?.(["anvil"]);
  for (let i = 0; i < 20; ++i) await new Promise((done) => setImmediate(done));
  assert.equal(recipes.get(), null);
});
