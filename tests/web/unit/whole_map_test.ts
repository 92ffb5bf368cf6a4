import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";

const { fetchWholeMap } = await import("../../../daemon/web/src/surface/whole_map.ts");
type Tile = import("../../../daemon/web/src/surface/height_tile.ts").Tile;
type Window = import("../../../daemon/web/src/surface/height_tile.ts").Window;

const width = 2500;
const height = 1030;
const known = { map_width: width, map_height: height } as Tile;
const value = (x: number, y: number): number => Math.fround(x + y / 2048);

function station(factor: number) {
  const asked: Window[] = [];
  const load = async (_job: string, _kind: string, window: Window | null): Promise<Tile> => {
    const { x, y, w, h } = window ?? assert.fail();
    asked.push({ x, y, w, h });
    const mean = Float32Array.from({ length: w * h }, (_, i) => value(x + (i % w), y + Math.floor(i / w)));
    return { ...known, kind: "height", window: { x, y, w, h }, width: w, height: h, factor, mean, lowest: mean, highest: mean };
  };
  return { asked, load };
}

test("the pieces cover the map once, and every point is in its place", async () => {
  const { asked, load } = station(1);
  const map = await fetchWholeMap("job", known, undefined, load);
  assert.equal(asked.reduce((sum, { w, h }) => sum + w * h, 0), width * height);
  for (const [x, y] of [[0, 0], [1023, 0], [1024, 0], [2499, 0], [0, 1024], [2048, 1029], [2499, 1029]] as const) {
    assert.equal(map.values[y * width + x], value(x, y));
  }
});

test("a piece that was reduced is no piece of the whole map", async () => {
  await assert.rejects(fetchWholeMap("job", known, undefined, station(2).load), /reduced by 2/);
});
