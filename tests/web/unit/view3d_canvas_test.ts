// Browsers have few WebGL contexts: each view gives its own back.
import assert from "node:assert/strict";
import { test } from "node:test";
import { render } from "preact";
import { SmallElement, drawn } from "./small_document.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { View3dCanvas } from "../../../daemon/web/src/pages/result/view3d_canvas.ts";
import { kFirstLook } from "../../../daemon/web/src/surface/view_angles.ts";

let contexts = 0;
let givenBack = 0;
let draws = 0;
const gl = new Proxy({} as Record<string, unknown>, {
  get: (_, name: string) => {
    switch (name) {
      case "isContextLost": return () => false;
      case "getProgramParameter": return () => true;
      case "getExtension": return () => ({ loseContext: () => ++givenBack });
      case "drawElements": return () => ++draws;
      default: return name === name.toUpperCase() ? 1 : () => ({});
    }
  },
});
Object.assign(SmallElement.prototype, {
  getContext: (kind: string) => {
    if (kind !== "webgl2") return null;
    ++contexts;
    return gl;
  },
});
Object.assign(globalThis, {
  requestAnimationFrame: (call: () => void) => setImmediate(call),
  cancelAnimationFrame: clearImmediate,
  addEventListener: () => undefined,
  removeEventListener: () => undefined,
});

const kHeights = {
  kind: "height", window: { x: 0, y: 0, w: 2, h: 2 }, width: 2, height: 2, factor: 1, map_width: 2, map_height: 2,
  mean: new Float32Array([0, 1e-6, 2e-6, 3e-6]),
};
const kLayer = { heights: kHeights, colours: kHeights };
const view = (): SmallElement => drawn(html`<${View3dCanvas} coarse=${kLayer} fine=${kLayer} map=${{ width: 2, height: 2, pitch_x: 1, pitch_y: 1 }} range=${{ low: 0, high: 3e-6 }}
  heights_um=${{ low: 0, high: 3 }} byTexture=${false} exaggeration=${1} look=${kFirstLook} moving=${false} canvas=${{ width: 10, height: 10 }} onMode=${() => undefined}/>`);
// Some of what it waits for comes with timers of Preact's; what never comes fails the test, after five seconds or more.
async function until(holds: () => boolean, what: string): Promise<void> {
  for (let i = 0; i < 5000; ++i) {
    if (holds()) return;
    await new Promise((done) => setTimeout(done, 1));
  }
  assert.fail(what);
}

test("a view that is left gives its context back, once, and not while it is shown", async () => {
  for (let views = 1; views <= 20; ++views) {
    const body = view();
    const before = draws;
    await until(() => draws > before, "it is drawn");
    assert.deepEqual([contexts, givenBack], [views, views - 1]);
    render(null, body as unknown as Element);
    await until(() => givenBack === views, "its context is given back");
  }
});

test("a context that came back after a loss is used again, and not given away", async () => {
  const body = view();
  const before = [givenBack, draws];
  await until(() => draws > (before[1] ?? 0), "it is drawn");
  const drawnOnce = draws;
  body.all("canvas")[0]?.listeners.get("webglcontextrestored")?.({});
  await until(() => draws > drawnOnce, "it is drawn again");
  assert.equal(givenBack, before[0]);
  render(null, body as unknown as Element);
  await until(() => givenBack === (before[0] ?? 0) + 1, "its context is given back");
});
