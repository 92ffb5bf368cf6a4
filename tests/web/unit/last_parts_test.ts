// The strip of the last parts.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { drawn } from "./small_document.ts";
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { link } from "../../../daemon/web/src/live/live.ts";
import { LastParts } from "../../../daemon/web/src/pages/run/last_parts.ts";

let most = 0;
globalThis.fetch = (async (_address: unknown, { body }: { body: string }) => {
  const { id, params } = JSON.parse(body) as { id: number; params: { most: number } };
  most = params.most;
  const jobs = Array.from({ length: most }, (_, i) => ({ job_id: `J${i}`, part_id: `P${i}`, state: i === 0 ? "processing" : "completed", verdict: "pass" }));
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, result: { jobs, next: "" } }), { status: 200 });
}) as unknown as typeof fetch;

before(() => loadTexts("en"));

test("twenty parts that ended are there, also while another one runs", async () => {
  link.set({ status: "open", since_ms: 0 });
  const all = drawn(html`<${LastParts}/>`);
  while (all.all("li").length === 0) await new Promise((done) => setImmediate(done));
  const parts = all.all(".part-id").map((each) => each.text);
  assert.deepEqual([parts.length, parts[0], parts[19]], [20, "P1", "P20"]);
});
