// The live picture of set-up and assistant: it takes turns with the commands of its tab, with the light that is set now.
import assert from "node:assert/strict";
import { before, beforeEach, test } from "node:test";
import { render } from "preact";
import { type SmallElement, drawn } from "./small_document.ts";
import { letTimersGo, passTime, stopTimers, turns } from "./stopped_timers.ts";
import { asCommand } from "../../../daemon/web/src/camera/devices_turn.ts";
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { topics } from "../../../daemon/web/src/live/live.ts";
import { CameraPicture } from "../../../daemon/web/src/parts/camera_picture.ts";
import { session } from "../../../daemon/web/src/rpc/session.ts";

const kDraw_ms = 100;  // after which Preact looks after effects, where there is no screen
const kPause_ms = 150;  // between pictures
let asked: { path: string; params: Record<string, unknown> }[] = [];
Object.assign(globalThis.document, { visibilityState: "visible" });
globalThis.fetch = (async (path: string, { body }: { body?: string }) => {
  const { id, params = {} } = JSON.parse(body ?? "{}") as { id?: number; params?: Record<string, unknown> };
  asked.push({ path, params });
  if (!body) return new Response("jpeg", { status: 200, headers: { "X-Fvd-Seq": "7", "X-Fvd-Z-Um": "55.5" } });
  const result = { seq: asked.length, width_px: 4, height_px: 2, z_um: 12.5, focus: 3, saturated_fraction: 0, png_base64: "AAAA" };
  return new Response(JSON.stringify({ jsonrpc: "2.0", id, result }), { status: 200 });
}) as unknown as typeof fetch;

async function until(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise((done) => setTimeout(done, 1));
}
const end = (all: SmallElement): void => render(null, all as unknown as Element);

before(async () => {
  await loadTexts("en");
  topics.update((all) => ({ ...all, health: { ok: true, stalled_threads: [], camera: { open: true }, stage: {} } as never }));
});
beforeEach(() => {
  asked = [];
});

test("who operates has pictures taken with the light that is set, and sees where the stage is", async () => {
  session.set({ who: "anna", role: "operate" });
  const places: number[] = [];
  const view = (exposure_us: number) => html`<${CameraPicture} params=${{ exposure_us }} onPlace=${(z_um: number) => places.push(z_um)}/>`;
  const all = drawn(view(500));
  await until(() => all.all("img").length > 0);
  assert.deepEqual(asked[0], { path: "/api/jsonrpc", params: { exposure_us: 500 } });
  assert.match(all.text, /z 12\.50 µm/);
  render(view(900), all as unknown as Element);
  await until(() => asked.at(-1)?.params["exposure_us"] === 900);
  assert.ok(places.includes(12.5));
  end(all);
});

test("no picture is taken while a command of this tab has the devices", async () => {
  session.set({ who: "anna", role: "operate" });
  stopTimers();
  const pass = async (ms: number): Promise<void> => {
    passTime(ms);
    await turns();
  };
  const all = drawn(html`<${CameraPicture} params=${{}}/>`);
  await pass(kDraw_ms);
  assert.equal(asked.length, 1);
  await pass(kPause_ms);
  assert.equal(asked.length, 2);
  await asCommand(async () => {
    for (let i = 0; i < 20; ++i) await pass(kPause_ms);
    assert.equal(asked.length, 2);
  });
  await pass(kPause_ms);
  assert.equal(asked.length, 3);
  letTimersGo();
  end(all);
});

test("who looks on sees what fvd shows anyhow, and has nothing taken", async () => {
  session.set({ who: "nobody", role: "view" });
  const all = drawn(html`<${CameraPicture} params=${{}}/>`);
  await until(() => all.all("img").length > 0);
  assert.ok(asked.every(({ path }) => path.startsWith("/api/v1/preview.jpg")));
  assert.match(all.text, /z 55\.50 µm/);
  end(all);
});
