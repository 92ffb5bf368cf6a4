// The log-in: who gives it up stays who he was, whatever is answered later.
import assert from "node:assert/strict";
import { before, beforeEach, test } from "node:test";
import { SmallElement, drawn } from "./small_document.ts";
import { turns } from "./stopped_timers.ts";

const { loadTexts } = await import("../../../daemon/web/src/i18n/i18n.ts");
const { html } = await import("../../../daemon/web/src/lib/html.ts");
const { SessionButton } = await import("../../../daemon/web/src/parts/session_button.ts");
const { setToken, token } = await import("../../../daemon/web/src/rpc/rpc.ts");
const { logIn, session } = await import("../../../daemon/web/src/rpc/session.ts");

let asked: { signal: AbortSignal; answer: (status: number) => void }[] = [];
let closes = 0;
let resets = 0;
let focused = 0;

globalThis.fetch = ((_address: unknown, { body, signal }: { body: string; signal: AbortSignal }) => new Promise((resolve) => {
  const { id } = JSON.parse(body) as { id: number };
  // A daemon that does not hear that nobody waits any more: its answer comes all the same.
  asked.push({ signal, answer: (status) => resolve(new Response(JSON.stringify(status === 200
    ? { jsonrpc: "2.0", id, result: { who: "token anna", role: "operate" } } : { error: "unauthorized", message: "nobody has this token" }), { status })) });
})) as unknown as typeof fetch;

// As a browser does it: closing a dialog, by whatever, is told to it.
Object.assign(SmallElement.prototype, {
  close(this: SmallElement) {
    ++closes;
    send(this, "close");
  },
  querySelector: () => ({ reset: () => ++resets }),
});
function send(element: SmallElement | undefined, name: string, target: unknown = element): void {
  const listener = element?.listeners.get(name);
  assert.ok(element && listener, name);
  listener.call(element, { type: name, target, preventDefault: () => undefined });
}

function dialog(): { form: SmallElement; submit: (text: string) => void; cancel: () => void; element: SmallElement } {
  const element = drawn(html`<${SessionButton}/>`).all("dialog")[0];
  assert.ok(element);
  const form = element.all("form")[0];
  assert.ok(form);
  const input = { value: "", focus: () => ++focused };
  return {
    element,
    form,
    submit: (text) => {
      input.value = text;
      send(form, "submit", { elements: { namedItem: () => input } });
    },
    cancel: () => send(element.all("button").find((button) => button.given.get("type") === "button"), "click"),
  };
}

before(() => loadTexts("en"));
beforeEach(() => {
  asked = [];
  closes = resets = focused = 0;
  setToken(null);
  session.set({ who: "nobody", role: "view" });
});

test("a log-in that was given up is no log-in, although its answer comes", async () => {
  const giving = new AbortController();
  const given = logIn("fvd-good", giving.signal);
  giving.abort();
  asked[0]?.answer(200);
  await assert.rejects(given);
  assert.equal(token.get(), null);
  assert.deepEqual(session.get(), { who: "nobody", role: "view" });
});

test("Cancel ends the asking, and its late answer logs nobody in", async () => {
  const { element, submit, cancel } = dialog();
  submit("fvd-good");
  await turns();
  assert.match(element.text, /Asking fvd/);
  cancel();
  assert.deepEqual([closes, resets, asked[0]?.signal.aborted], [1, 1, true]);
  asked[0]?.answer(200);
  await turns();
  assert.equal(token.get(), null);
  assert.deepEqual(session.get(), { who: "nobody", role: "view" });
  assert.doesNotMatch(element.text, /Asking fvd/);
});

test("so does Esc, which closes a dialog without a press", async () => {
  const { element, submit } = dialog();
  submit("fvd-typo");
  send(element, "close");
  asked[0]?.answer(401);
  await turns();
  assert.equal(element.all("p").some((each) => each.given.get("role") === "alert"), false, "a refusal of what nobody wants any more is not told");
  assert.equal(focused, 0);
  submit("fvd-good");
  assert.equal(asked.length, 2, "the next one may be asked for at once");
});

test("who waits is logged in; a wrong token is told and may be typed again; one is asked for at a time", async () => {
  const { element, submit } = dialog();
  submit("fvd-typo");
  submit("fvd-typo");
  assert.equal(asked.length, 1);
  asked[0]?.answer(401);
  await turns();
  assert.match(element.text, /Nobody has this token/);
  assert.equal(focused, 1);
  submit(" fvd-good ");
  asked[1]?.answer(200);
  await turns();
  assert.equal(token.get(), "fvd-good");
  assert.equal(session.get().role, "operate");
});
