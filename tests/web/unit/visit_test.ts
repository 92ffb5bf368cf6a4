// A page that is left keeps no request, and begins nothing until it is back.
import assert from "node:assert/strict";
import { getEventListeners } from "node:events";
import { afterEach, test } from "node:test";
import "./browser_stand_in.ts";

const { comeBack, leave, leavings, whileHere } = await import("../../../daemon/web/src/lib/visit.ts");
const { RpcError, call } = await import("../../../daemon/web/src/rpc/rpc.ts");

let asked: { method: string; signal: AbortSignal | undefined }[] = [];
globalThis.fetch = ((_address: unknown, { body = "", signal }: { body?: string; signal?: AbortSignal }) => {
  asked.push({ method: (JSON.parse(body) as { method: string }).method, signal });
  return new Promise((_resolve, reject) => signal?.addEventListener("abort", () => reject(new Error("aborted"))));
}) as unknown as typeof fetch;

afterEach(() => {
  comeBack();
  asked = [];
});

const isOffline = (error: unknown): boolean => error instanceof RpcError && error.error === "offline";

test("what is under way ends as the page is left, and what would begin does not", async () => {
  const before = leavings.get();
  const first = call("system.state", {});
  leave();
  await assert.rejects(first, isOffline);
  await assert.rejects(call("stage.home", {}), isOffline);
  assert.deepEqual(asked.map(({ method }) => method), ["system.state"]);
  assert.equal(leavings.get(), before + 1);
  comeBack();
  const again = call("system.state", {});
  assert.equal(asked.length, 2);
  leave();
  await assert.rejects(again, isOffline);
});

test("a stop is sent also then, and nothing ends it", () => {
  void call("stage.stop", {});
  leave();
  void call("job.abort", { job_id: "J" });
  assert.deepEqual(asked.map(({ method, signal }) => [method, signal?.aborted ?? false]), [["stage.stop", false], ["job.abort", false]]);
});

test("the outer signal ends it too, and has no listener afterwards", async () => {
  const outer = new AbortController();
  assert.equal(await whileHere(async () => "done", outer.signal), "done");
  assert.equal(getEventListeners(outer.signal, "abort").length, 0);
  const never = whileHere((signal) => new Promise((_resolve, reject) => signal.addEventListener("abort", () => reject(new Error("over")))), outer.signal);
  outer.abort();
  await assert.rejects(never, /over/);
  assert.equal(getEventListeners(outer.signal, "abort").length, 0);
});
