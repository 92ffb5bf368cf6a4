// Files that are made after a verdict appear on the page that was open before.
import assert from "node:assert/strict";
import { afterEach, before, beforeEach, test } from "node:test";
import { drawn } from "./small_document.ts";
import { letTimersGo, passTime, stopTimers, turns } from "./stopped_timers.ts";
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { Downloads } from "../../../daemon/web/src/pages/result/downloads.ts";
import type { ResultFile, ResultJson } from "../../../daemon/web/src/result/result_json.ts";

const kDraw_ms = 100;  // after which Preact looks after effects, where there is no screen
let answers: (ResultFile[] | "offline" | "removed" | null)[] = [];
let asked = 0;

globalThis.fetch = (async (_address: unknown, { body }: { body: string }) => {
  ++asked;
  const files = answers.shift();
  if (files === "offline" || files === undefined) throw new TypeError("the cable was pulled");
  const said = files === "removed" ? { error: { code: 1018, message: "the result was removed", data: { error: "result_removed" } } }
    : { result: { result: files === null ? null : { files } } };
  return new Response(JSON.stringify({ jsonrpc: "2.0", id: (JSON.parse(body) as { id: number }).id, ...said }), { status: 200 });
}) as unknown as typeof fetch;

const kHeights: ResultFile = { name: "height.tiff", state: "written", size_bytes: 2048 };
const report = (state: string): ResultFile => ({ name: "report.pdf", state, ...(state === "written" ? { size_bytes: 10240 } : {}) });
const resultWith = (files: ResultFile[]): ResultJson => ({ job: { job_id: "20261130-1", seq: 1, part_id: "P", recipe: "r" }, verdict: "pass", files });
async function pass(ms: number): Promise<void> {
  passTime(ms);
  await turns();
}

before(() => loadTexts("en"));
beforeEach(() => {
  answers = [];
  asked = 0;
  stopTimers();
});
afterEach(letTimersGo);

test("a file that is being made has no link, and gets one when it is there", async () => {
  const all = drawn(html`<${Downloads} result=${resultWith([kHeights, report("pending")])}/>`);
  const links = (): string[] => all.all("a").map((each) => each.text);
  assert.deepEqual(links(), ["height.tiff", "result.json"]);
  assert.match(all.text, /report\.pdf.*is being made/);
  answers = [[kHeights, report("pending")], "offline", [kHeights, report("written")]];
  await pass(kDraw_ms);
  for (const wait_ms of [1000, 2000, 4000]) await pass(wait_ms);
  await pass(kDraw_ms);
  assert.equal(asked, 3);
  assert.deepEqual(links(), ["report.pdf", "height.tiff", "result.json"]);
  await pass(600000);
  assert.equal(asked, 3, "then nothing is asked any more");
});

for (const answer of ["removed", null] as const) {
  test(`a result that is no longer there (${answer}) leaves what is shown, and nothing more is asked`, async () => {
    const all = drawn(html`<${Downloads} result=${resultWith([kHeights, report("pending")])}/>`);
    answers = [[kHeights, report("pending")], answer];
    await pass(kDraw_ms);
    for (const wait_ms of [1000, 2000, kDraw_ms]) await pass(wait_ms);
    assert.equal(asked, 2);
    assert.match(all.text, /report\.pdf.*is being made/);
    assert.deepEqual(all.all("a").map((each) => each.text), ["height.tiff", "result.json"]);
    await pass(600000);
    assert.equal(asked, 2);
  });
}

test("nothing is asked for a result whose files are all there, or will never be", async () => {
  drawn(html`<${Downloads} result=${resultWith([kHeights, report("not_made")])}/>`);
  await pass(kDraw_ms);
  await pass(60000);
  assert.equal(asked, 0);
});
