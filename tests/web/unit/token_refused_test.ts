// A token that nobody has, or that was withdrawn while a tab was open: the tab says so and looks on.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import "./browser_stand_in.ts";

const { RpcError, ask, call, refuseToken, setToken, token, tokenWasRefused } = await import("../../../daemon/web/src/rpc/rpc.ts");
const { look } = await import("../../../daemon/web/src/rpc/look.ts");
const { logIn, logOut, session, watchRefusals } = await import("../../../daemon/web/src/rpc/session.ts");

const kValid = "fvd-good";
const enter = (text: string): Promise<void> => logIn(text, new AbortController().signal);
let asked: (string | undefined)[] = [];  // the Authorization of each request
let hold: Promise<void> = Promise.resolve();

globalThis.fetch = (async (_address: unknown, init: { body?: string; headers: Record<string, string> }) => {
  const given = init.headers["Authorization"];
  asked.push(given);
  await hold;
  if (given !== undefined && given !== `Bearer ${kValid}`) {
    return new Response(JSON.stringify({ error: "unauthorized", message: "nobody has this token" }), { status: 401 });
  }
  const answer = (id: unknown): unknown => ({ jsonrpc: "2.0", id, result: given ? { who: "token anna", role: "operate" } : { who: "nobody", role: "view" } });
  const body = JSON.parse(init.body ?? "{}") as { id?: unknown } | { id?: unknown }[];
  return new Response(JSON.stringify(Array.isArray(body) ? body.map(({ id }) => answer(id)) : answer(body.id)), { status: 200 });
}) as unknown as typeof fetch;

const isRefusal = (error: unknown): boolean => error instanceof RpcError && error.code === 401;
async function until(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise((done) => setImmediate(done));
}

beforeEach(() => {
  setToken(null);
  session.set({ who: "", role: "none" });
  asked = [];
  hold = Promise.resolve();
});

test("a call that is refused makes the tab forget its token, and say so", async () => {
  const unwatch = watchRefusals();
  setToken("fvd-withdrawn");
  session.set({ who: "token anna", role: "operate" });
  await assert.rejects(call("system.state", {}), isRefusal);
  assert.equal(token.get(), null);
  assert.equal(sessionStorage.getItem("fvd.token"), null);
  assert.equal(tokenWasRefused.get(), true);
  await until(() => session.get().role === "view");
  assert.deepEqual(asked, ["Bearer fvd-withdrawn", undefined], "the wrong one is shown once: each is answered later than the one before");
  unwatch();
});

test("where fvd says nothing without a token, the tab is nobody, and not who it was", async () => {
  const unwatch = watchRefusals();
  setToken("fvd-withdrawn");
  session.set({ who: "token anna", role: "operate" });
  hold = Promise.resolve().then(() => {
    hold = new Promise(() => undefined);  // the next one is not answered
  });
  await assert.rejects(call("system.state", {}), isRefusal);
  await until(() => asked.length === 2);
  assert.deepEqual(session.get(), { who: "", role: "none" });
  unwatch();
});

test("so does a batch of looks, and whatever is fetched", async () => {
  setToken("fvd-withdrawn");
  const both = await Promise.allSettled([look("system.state", {}), look("control.state", {})]);
  assert.ok(both.every((each) => each.status === "rejected" && isRefusal(each.reason)));
  assert.equal(tokenWasRefused.get(), true);
  setToken("fvd-withdrawn");
  assert.equal((await ask("/api/v1/preview.jpg?after=0", {})).status, 401);
  assert.equal(tokenWasRefused.get(), true);
});

test("a token that is typed wrong leaves the tab as it was", async () => {
  await assert.rejects(enter("fvd-typo"), isRefusal);
  assert.equal(tokenWasRefused.get(), false);
  setToken(kValid);
  await assert.rejects(enter("fvd-typo"), isRefusal);
  assert.equal(token.get(), kValid);
});

test("a late refusal does not take the token that was given meanwhile", async () => {
  setToken("fvd-withdrawn");
  let release = (): void => undefined;
  hold = new Promise((resolve) => (release = resolve));
  const late = call("system.state", {});
  await until(() => asked.length === 1);
  setToken(kValid);
  release();
  await assert.rejects(late, isRefusal);
  assert.equal(token.get(), kValid);
  assert.equal(tokenWasRefused.get(), false);
});

test("the word is gone once somebody logs in, or wants no token", async () => {
  setToken("fvd-withdrawn");
  refuseToken("fvd-withdrawn");
  await enter(kValid);
  assert.equal(tokenWasRefused.get(), false);
  assert.deepEqual(session.get(), { who: "token anna", role: "operate" });
  refuseToken(kValid);
  await logOut();
  assert.equal(tokenWasRefused.get(), false);
  assert.equal(session.get().role, "view");
});

test("a refusal without a token is nobody's", () => {
  refuseToken(null);
  assert.equal(tokenWasRefused.get(), false);
});
