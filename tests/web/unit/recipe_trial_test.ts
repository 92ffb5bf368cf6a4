// A trial scan is a job like any other: it is acknowledged by who asked for it, or results would pile up.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import "./browser_stand_in.ts";

const { pressed, scanBy } = await import("../../../daemon/web/src/recipe/try_recipe.ts");

let asked: { method: string; params: Record<string, unknown> }[] = [];
let waits: Record<string, unknown>[] = [];
let mayAcknowledge = true;

globalThis.fetch = (async (_address: unknown, { body }: { body: string }) => {
  const { id, method, params } = JSON.parse(body) as { id: number; method: string; params: Record<string, unknown> };
  asked.push({ method, params });
  const results: Record<string, unknown> = {
    "job.latest": { newest_seq: 6 }, "job.start": { job_id: "J7" }, "job.wait": method === "job.wait" ? waits.shift() : null, "result.get": { result: { verdict: "pass" } }, "result.ack": { remaining: 0 },
  };
  const refused = method === "result.ack" && !mayAcknowledge;
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, ...(refused ? { error: { code: 1133, message: "the database is gone" } } : { result: results[method] }) }), { status: 200 });
}) as unknown as typeof fetch;

const of = (method: string): Record<string, unknown>[] => asked.filter((each) => each.method === method).map(({ params }) => params);

beforeEach(() => {
  asked = [];
  mayAcknowledge = true;
});

test("a trial scan is followed to its end, and its result acknowledged", async () => {
  waits = [{ progress: 0.5, done: false }, { progress: 1, done: true, state: "completed" }];
  const told: number[] = [];
  assert.deepEqual(await scanBy("try_r", "trial", pressed(), (progress) => told.push(progress)), { id: "J7", result: { verdict: "pass" } });
  assert.deepEqual(told, [0.5, 1]);
  assert.deepEqual(of("job.start"), [{ seq: 7, part_id: "trial", recipe: "try_r", client: "page" }]);
  assert.deepEqual(of("result.ack"), [{ job_id: "J7" }]);
});

test("so is one that failed, whose reason is told", async () => {
  waits = [{ progress: 0.2, done: true, state: "failed", error: "stage_lost", error_message: "the stage is gone" }];
  await assert.rejects(scanBy("try_r", "trial", pressed(), () => undefined), /stage_lost: the stage is gone/);
  assert.deepEqual(of("result.ack"), [{ job_id: "J7" }]);
});

test("an acknowledgement that is refused takes nothing from the trial", async () => {
  mayAcknowledge = false;
  waits = [{ progress: 1, done: true, state: "completed" }];
  assert.equal((await scanBy("try_r", "trial", pressed(), () => undefined)).id, "J7");
});
