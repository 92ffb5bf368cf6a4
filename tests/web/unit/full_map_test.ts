import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";

const { FullMap } = await import("../../../daemon/web/src/surface/full_map.ts");
type Tile = import("../../../daemon/web/src/surface/height_tile.ts").Tile;
type Window = import("../../../daemon/web/src/surface/height_tile.ts").Window;

// A map whose point (column, row) is 1000 * row + column.
function loader(asked: string[]) {
  return async (_job: string, kind: Tile["kind"], window: Window | null): Promise<Tile> => {
    const { x, y, w, h } = window!;
    asked.push(`${kind} ${x},${y} ${w}x${h}`);
    const mean = Float32Array.from({ length: w * h }, (_, i) => 1000 * (y + Math.floor(i / w)) + x + (i % w));
    return { kind, window: { x, y, w, h }, width: w, height: h, factor: 1, map_width: 600, map_height: 300, mean, lowest: mean, highest: mean };
  };
}

test("every point is read from its own block, which is fetched once", async () => {
  const asked: string[] = [];
  const map = new FullMap("j", 600, 300, loader(asked));
  assert.equal(await map.at("height", { column: 599, row: 299 }), 299599);
  assert.equal(await map.at("height", { column: 512, row: 256 }), 256512);
  assert.equal(await map.at("sigma", { column: 0, row: 0 }), 0);
  assert.deepEqual(asked, ["height 512,256 88x44", "sigma 0,0 256x256"]);
});

test("a failure is not kept", async () => {
  let fails = true;
  const load = loader([]);
  const map = new FullMap("j", 600, 300, (...all) => (fails ? Promise.reject(new Error("gone")) : load(all[0], all[1], all[2])));
  await assert.rejects(map.at("height", { column: 1, row: 1 }), /gone/);
  fails = false;
  assert.equal(await map.at("height", { column: 1, row: 1 }), 1001);
});
