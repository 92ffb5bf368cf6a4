import assert from "node:assert/strict";
import { test } from "node:test";
import "./browser_stand_in.ts";

// Of the page's own address, and what hears that it changed.
const heard = new Map<string, () => void>();
Object.assign(globalThis, {
  addEventListener: (name: string, listener: () => void) => void heard.set(name, listener),
  removeEventListener: (name: string) => void heard.delete(name),
  location: { hash: "", pathname: "/jobs", search: "" },
});

const { addressFault, tokenIn, takeTokenFromAddress, watchAddress } = await import("../../../daemon/web/src/rpc/token_in_address.ts");
const { call, setToken, token } = await import("../../../daemon/web/src/rpc/rpc.ts");
const { session } = await import("../../../daemon/web/src/rpc/session.ts");

const open = (hash: string, opened: () => void = takeTokenFromAddress): string[] => {
  const shown: string[] = [];
  Object.defineProperty(globalThis, "location", { value: { hash, pathname: "/jobs", search: "?a=1" }, configurable: true });
  Object.defineProperty(globalThis, "history", {
    value: { state: null, replaceState: (_state: unknown, _title: string, address: string) => shown.push(address) },
    configurable: true,
  });
  opened();
  return shown;
};

test("a kiosk's token stands behind the address", () => {
  assert.equal(tokenIn("#token=fvd-0123"), "fvd-0123");
  assert.equal(tokenIn("#a=b&token=fvd-0123"), "fvd-0123");
  for (const hash of ["", "#", "#token=", "#token=%20", "#other"]) assert.equal(tokenIn(hash), null, hash);
});

test("it is taken, and stands in no address any more", () => {
  assert.deepEqual(open("#token=fvd-0123"), ["/jobs?a=1"]);
  assert.equal(token.get(), "fvd-0123");
  assert.deepEqual(open("#token="), []);
  assert.equal(token.get(), "fvd-0123");
});

test("put into an open page it is taken out at once, and logs in unless it is refused", async () => {
  let answers: ((response: Response) => void)[] = [];
  globalThis.fetch = (() => new Promise((resolve) => answers.push(resolve))) as unknown as typeof fetch;
  const settled = () => new Promise((done) => setImmediate(done));
  const good = (who: string): Response => new Response(JSON.stringify({ jsonrpc: "2.0", id: 1, result: { who, role: "operate" } }));
  const refused = (): Response => new Response(JSON.stringify({ error: "unauthorized", message: "nobody has this token" }), { status: 401 });
  const paste = (hash: string): string[] => open(hash, () => heard.get("hashchange")?.());
  setToken("fvd-old");
  session.set({ who: "token old", role: "view" });
  const end = watchAddress();

  assert.deepEqual(paste("#token=fvd-wrong"), ["/jobs?a=1"]);
  answers.shift()?.(refused());
  await settled();
  assert.deepEqual([token.get(), session.get().who], ["fvd-old", "token old"]);
  assert.notEqual(addressFault.get(), null);

  assert.deepEqual(paste("#token=fvd-new"), ["/jobs?a=1"]);
  assert.equal(addressFault.get(), null);
  answers.shift()?.(good("token new"));
  await settled();
  assert.deepEqual([token.get(), session.get().who], ["fvd-new", "token new"]);

  // Who logs out while it is asked for stays logged out.
  paste("#token=fvd-old");
  setToken(null);
  answers.shift()?.(good("token old"));
  await settled();
  assert.equal(token.get(), null);

  // A call of who the tab was is refused meanwhile: that is no word of a person, and the pasted one stays asked for.
  setToken("fvd-old");
  const late = call("system.state", {}).catch(() => undefined);
  paste("#token=fvd-new");
  answers.shift()?.(refused());
  await late;
  assert.equal(token.get(), null);
  answers.shift()?.(good("token new"));
  await settled();
  assert.deepEqual([token.get(), session.get().who], ["fvd-new", "token new"]);

  assert.deepEqual(paste("#elsewhere"), []);
  assert.equal(answers.length, 0);
  end();
  assert.equal(heard.has("hashchange"), false);
  answers = [];
});
