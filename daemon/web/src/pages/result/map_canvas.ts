// Draws tiles of a map into a canvas: the overview first, a sharper piece of what is seen over it when it has come.
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { html } from "../../lib/html.ts";
import { type Kind, type Tile, fetchTile } from "../../surface/height_tile.ts";
import type { Range } from "../../surface/colours.ts";
import { kGreyTable, kViridisTable } from "../../surface/colours.ts";
import { type MapSize, type Size, type View, toScreen, wantedTile } from "../../surface/map_view.ts";
import { paintReasons, paintValues } from "../../surface/paint.ts";

export type Plane = "mean" | "lowest" | "highest";

interface Props {
  job: string;
  kind: Kind;
  map: MapSize;
  overview: Tile;
  range: Range;  // in the tile's unit
  plane: Plane;
  view: View;
  canvas: Size;
  onFactor: (factor: number) => void;  // of the finest piece that is shown
  onError: (error: unknown) => void;
}

const kWait_ms = 120;  // while the view moves, nothing is fetched

function pictureOf(tile: Tile, range: Range, plane: Plane): HTMLCanvasElement {
  const picture = document.createElement("canvas");
  picture.width = tile.width;
  picture.height = tile.height;
  const image = new ImageData(tile.width, tile.height);
  const pixels = new Uint32Array(image.data.buffer);
  if (tile.kind === "reason") paintReasons(tile.mean, pixels);
  else paintValues(tile[plane], range, tile.kind === "texture" ? kGreyTable : kViridisTable, pixels);
  picture.getContext("2d")?.putImageData(image, 0, 0);
  return picture;
}

export function MapCanvas({ job, kind, map, overview, range, plane, view, canvas, onFactor, onError }: Props) {
  const element = useRef<HTMLCanvasElement>(null);
  const pictures = useRef(new WeakMap<Tile, { key: string; picture: HTMLCanvasElement }>());
  const [detail, setDetail] = useState<Tile | null>(null);
  const ratio = globalThis.devicePixelRatio || 1;

  const wanted = wantedTile(view, canvas, map, ratio);
  const key = wanted && wanted.factor < overview.factor ? JSON.stringify([job, kind, wanted]) : "";
  useEffect(() => {
    if (!wanted || key === "") {
      setDetail(null);
      return;
    }
    const abort = new AbortController();
    const timer = setTimeout(() => {
      fetchTile(job, kind, wanted.window, wanted.most, abort.signal).then(setDetail, (error: unknown) => {
        if (!abort.signal.aborted) onError(error);
      });
    }, kWait_ms);
    return () => {
      clearTimeout(timer);
      abort.abort();
    };
  }, [key]);

  const shown = detail?.kind === kind ? detail : null;
  const factor = shown?.factor ?? overview.factor;
  useEffect(() => onFactor(factor), [factor]);

  // Within the frame in which the overlay moves: else line and cursor would run ahead of the map.
  useLayoutEffect(() => {
    const target = element.current;
    const context = target?.getContext("2d");
    if (!target || !context) return;
    const [width, height] = [Math.round(canvas.width * ratio), Math.round(canvas.height * ratio)];
    if (target.width !== width || target.height !== height) {
      target.width = width;
      target.height = height;
    }
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    context.scale(ratio, ratio);
    context.imageSmoothingEnabled = false;
    const colours = `${range.low} ${range.high} ${plane}`;
    for (const tile of shown ? [overview, shown] : [overview]) {
      let known = pictures.current.get(tile);
      if (known?.key !== colours) {
        known = { key: colours, picture: pictureOf(tile, range, plane) };
        pictures.current.set(tile, known);
      }
      // The last block of a row may reach beyond the map; its picture is cut there.
      const { x, y, w, h } = tile.window;
      const from = toScreen(view, canvas, { x: x * map.pitch_x, y: y * map.pitch_y });
      const to = toScreen(view, canvas, { x: (x + w) * map.pitch_x, y: (y + h) * map.pitch_y });
      context.drawImage(known.picture, 0, 0, w / tile.factor, h / tile.factor, from.x, from.y, to.x - from.x, to.y - from.y);
    }
  }, [overview, shown, range.low, range.high, plane, view, canvas.width, canvas.height, ratio]);

  return html`<canvas ref=${element} class="map-canvas" aria-hidden="true" style=${{ aspectRatio: `${canvas.width} / ${canvas.height}` }}></canvas>`;
}
