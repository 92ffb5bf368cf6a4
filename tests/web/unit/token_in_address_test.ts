import assert from "node:assert/strict";
import { test } from "node:test";
import "./browser_stand_in.ts";

const { tokenIn, takeTokenFromAddress } = await import("../../../daemon/web/src/rpc/token_in_address.ts");
const { token } = await import("../../../daemon/web/src/rpc/rpc.ts");

const open = (hash: string): string[] => {
  const shown: string[] = [];
  Object.defineProperty(globalThis, "location", { value: { hash, pathname: "/jobs", search: "?a=1" }, configurable: true });
  Object.defineProperty(globalThis, "history", {
    value: { state: null, replaceState: (_state: unknown, _title: string, address: string) => shown.push(address) },
    configurable: true,
  });
  takeTokenFromAddress();
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
