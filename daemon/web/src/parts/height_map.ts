// A job's height map in colours, with its colour bar and a scale bar: for a look, not for work.
import { useEffect, useRef, useState } from "preact/hooks";
import { number, t, useLanguage } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { useStore } from "../lib/store.ts";
import { link } from "../live/live.ts";
import { percentileRange, wholeRange } from "../surface/colour_range.ts";
import { type Range, kHoleColour, kViridisTable, level, rgba } from "../surface/colours.ts";
import { type Tile, fetchTile } from "../surface/height_tile.ts";
import { barLength, ticks } from "../surface/ticks.ts";
import { framed } from "./framed.ts";
import { messageOf } from "./message_of.ts";

const kMost = 512;
const kUm = 1e6;

interface Shown {
  tile: Tile;
  valid: number;         // samples with a height
  colours_um: Range | null;
  whole_um: Range | null;
}

function shownOf(tile: Tile): Shown {
  const inUm = (range: Range | null): Range | null => range && { low: range.low * kUm, high: range.high * kUm };
  return {
    tile,
    valid: tile.mean.reduce((count, value) => (Number.isNaN(value) ? count : count + 1), 0),
    colours_um: inUm(percentileRange(tile.mean, 0.005, 0.995)),
    whole_um: inUm(wholeRange(tile.lowest, tile.highest)),
  };
}

function paint(canvas: HTMLCanvasElement, { tile, colours_um }: Shown): void {
  canvas.width = tile.width;
  canvas.height = tile.height;
  const context = canvas.getContext("2d");
  if (!context) return;
  const image = context.createImageData(tile.width, tile.height);
  const pixels = new Uint32Array(image.data.buffer);
  const words = kViridisTable.map(rgba);
  const range = colours_um ?? { low: 0, high: 1 };
  tile.mean.forEach((value, i) => {
    pixels[i] = Number.isNaN(value) ? rgba(kHoleColour) : (words[level(value * kUm, range)] as number);
  });
  context.putImageData(image, 0, 0);
}

function paintBar(canvas: HTMLCanvasElement): void {
  canvas.width = 1;
  canvas.height = 256;
  const context = canvas.getContext("2d");
  if (!context) return;
  const image = context.createImageData(1, 256);
  new Uint32Array(image.data.buffer).set(kViridisTable.map(rgba).reverse());
  context.putImageData(image, 0, 0);
}

function ColourBar({ range }: { range: Range }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (canvas.current) paintBar(canvas.current);
  }, []);
  const { values, digits } = ticks(range.low, range.high, 6);
  return html`<div class="map-colour-bar" aria-hidden="true">
    <canvas ref=${canvas}></canvas>
    <div class="colour-ticks">${values.map((value) => html`
      <span style=${{ bottom: `${range.high > range.low ? 100 * (value - range.low) / (range.high - range.low) : 50}%` }}>${number(value, Math.min(digits, 3))}</span>`)}</div>
    <span class="colour-unit">µm</span>
  </div>`;
}

export interface Pitch {
  x: number;  // um on the object from column to column of the map
  y: number;
}

interface Props {
  jobId: string;
  pitch: Pitch | null;      // null = not known (yet): no scale bar
  verdict?: string;         // in words, for the summary
  noPointReason?: string;   // why most points are holes, in words
}

export function HeightMap({ jobId, pitch, verdict = "", noPointReason = "" }: Props) {
  useLanguage();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [shown, setShown] = useState<(Shown & { jobId: string }) | null>(null);
  const [problem, setProblem] = useState("");
  const isLinked = useStore(link).status === "open";
  const has = shown?.jobId === jobId;
  useEffect(() => {
    if (has || !isLinked) return;
    const abort = new AbortController();
    fetchTile(jobId, "height", null, kMost, abort.signal).then((tile) => {
      setProblem("");
      setShown({ ...shownOf(tile), jobId });
    }, (error: unknown) => {
      if (!abort.signal.aborted) setProblem(messageOf(error));
    });
    return () => abort.abort();
  }, [jobId, isLinked, has]);
  useEffect(() => {
    if (has && canvas.current) paint(canvas.current, shown);
  }, [shown, has]);
  if (!has) return html`<div class="height-map"><p class="picture-says">${problem ? t("map.problem", { problem }) : t("map.loading")}</p></div>`;

  const { tile, colours_um, whole_um, valid } = shown;
  const summary = whole_um === null
    ? t("map.no_point")
    : t("map.summary", { low: number(whole_um.low, 2), high: number(whole_um.high, 2), share: number(100 * valid / (tile.width * tile.height), 1) });
  const width_um = tile.map_width * (pitch?.x ?? 1);
  const height_um = tile.map_height * (pitch?.y ?? 1);
  const bar_um = barLength(width_um * 0.3);
  return html`<figure class="height-map">
    <div class="height-map-row">
      <div class="picture" style=${framed(width_um, height_um)}>
        <canvas ref=${canvas} role="img" aria-label=${`${t("map.alt")} ${summary} ${verdict}`}></canvas>
        ${pitch && html`<span class="map-scale-bar" aria-hidden="true" style=${{ width: `${100 * bar_um / width_um}%` }}><span>${number(bar_um)} µm</span></span>`}
        ${whole_um === null && html`<p class="picture-says" role="alert">${t("map.no_point")} ${noPointReason}</p>`}
      </div>
      ${colours_um && html`<${ColourBar} range=${colours_um}/>`}
    </div>
    <figcaption class="help">${summary}${whole_um !== null && ` ${t("map.holes")}`}</figcaption>
  </figure>`;
}
