// A page that somebody goes to begins at its top; one whose address is only put right stays where it is.
import assert from "node:assert/strict";
import { test } from "node:test";

const did: string[] = [];
Object.assign(globalThis, {
  location: { pathname: "/", search: "" },
  history: { pushState: (_state: unknown, _title: string, address: string) => did.push(`push ${address}`), replaceState: (_state: unknown, _title: string, address: string) => did.push(`replace ${address}`) },
  scrollTo: (x: number, y: number) => did.push(`to ${x},${y}`),
});
const { go } = await import("../../../daemon/web/src/lib/router.ts");

test("a new page begins at its top", () => {
  go("/setup");
  go("/jobs?part=7", { replace: true });
  assert.deepEqual(did, ["push /setup", "to 0,0", "replace /jobs?part=7"]);
});
