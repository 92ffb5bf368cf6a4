// The map that one can hold, drawn without a browser: whose width it follows, and what is under the cursor.
import { SmallElement, drawn } from "./small_document.ts";
import assert from "node:assert/strict";
import test from "node:test";
import { MapStage } from "../../../daemon/web/src/pages/result/map_stage.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import type { Point } from "../../../daemon/web/src/surface/full_map.ts";
import type { Tile } from "../../../daemon/web/src/surface/height_tile.ts";

const kBorder = 1;

let watched: SmallElement[] = [];
Object.assign(globalThis, {
  innerHeight: 1000,
  ResizeObserver: class {
    observe(element: SmallElement): void {
      watched.push(element);
    }
    disconnect(): void {
      watched = [];
    }
  },
});
// Of all elements, the stage alone has a border.
Object.defineProperty(SmallElement.prototype, "clientWidth", {
  get(this: SmallElement) {
    return this.given.get("class") === "map-stage" ? 400 - 2 * kBorder : 400;
  },
});
// The stage's border is at 10.25, 20.5.
Object.defineProperty(SmallElement.prototype, "getBoundingClientRect", {
  value: () => ({ left: 10.25 + kBorder, top: 20.5 + kBorder, width: 398, height: 398 / 2 }),
});
Object.defineProperty(SmallElement.prototype, "querySelector", {
  value(this: SmallElement, wanted: string) {
    return this.all(wanted)[0] ?? null;
  },
});

const size = { width: 796, height: 398, pitch_x: 0.5, pitch_y: 0.5 };
const plane = new Float32Array(4);
const overview: Tile = {
  kind: "height", window: { x: 0, y: 0, w: 796, h: 398 }, width: 2, height: 2, factor: 1, map_width: 796, map_height: 398,
  mean: plane, lowest: plane, highest: plane,
};

Object.defineProperty(SmallElement.prototype, "setPointerCapture", { value: () => undefined });

// The stage when it knows its width, and the points that the cursor was at.
async function stageOf(): Promise<{ page: SmallElement; stage: SmallElement; seen: (Point | null)[] }> {
  const seen: (Point | null)[] = [];
  const none = (): void => undefined;
  const page = drawn(html`<${MapStage} map=${{ full: { job: "j" }, size, has_pitch: true, unit: "µm" }} overview=${overview} range=${{ low: 0, high: 1 }}
    plane="mean" summary="" shapes=${[]} line=${{ from: { x: 0, y: 0 }, to: { x: 1, y: 1 }, width_um: 0 }} marks=${[]} cursor=${null}
    onCursor=${(at: Point | null) => seen.push(at)} onLine=${none} onFactor=${none} onError=${none}/>`);
  await new Promise((tell) => setTimeout(tell));  // it is drawn anew when it knows its width
  const [stage] = page.all(".map-stage");
  assert.ok(stage);
  return { page, stage, seen };
}

function send(stage: SmallElement, type: string, clientX: number, clientY: number): void {
  const listener = stage.listeners.get(type);
  assert.ok(listener, type);
  listener.call(stage, { type, button: 0, currentTarget: stage, clientX, clientY });
}

test("the width is the stage's own, without its border, and the cursor is at the point under the pointer", async () => {
  const { page, stage, seen } = await stageOf();
  assert.deepEqual(watched, [stage]);
  assert.equal(page.all(".map-overlay")[0]?.given.get("viewBox"), "0 0 398 220");

  // 398 x 199 um on 398 x 220 pixels, in the middle; shown in a box of 199 pixels' height, where a pixel is 220 / 199.
  send(stage, "pointermove", 11.25, 21.5 + 99.5);
  send(stage, "pointermove", 11.25 + 100.6, 21.5 + 99.5);
  send(stage, "pointermove", 11.25 + 397.9, 21.5 + 99.5);
  assert.deepEqual(seen, [{ column: 0, row: 199 }, { column: 201, row: 199 }, { column: 795, row: 199 }]);
});

test("a map that is dragged keeps the point under the pointer, also before it is drawn anew", async () => {
  const { stage, seen } = await stageOf();
  send(stage, "pointermove", 211.3, 121);
  send(stage, "pointerdown", 211.3, 121);
  send(stage, "pointermove", 171.3, 101);
  await new Promise((tell) => setTimeout(tell));
  send(stage, "pointermove", 180.3, 131);
  assert.ok(seen[0]);
  assert.deepEqual(seen.slice(1), [seen[0], seen[0]]);
});
