// A map as a picture with its bar of colours.
import { useEffect, useRef } from "preact/hooks";
import { number } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { type Range, cssColour, kPartingTable, kViridisTable } from "../surface/colours.ts";
import { pictureOf } from "../surface/paint.ts";

const kBar_px = 256;
const kAny: Range = { low: 0, high: 1 };

export function MapPicture({ values, width, height, range, parting, label, digits }: {
  values: Float32Array;  // metres
  width: number;
  height: number;
  range: Range | null;   // null = no point has a height: there is nothing to colour
  parting?: boolean;     // two colours that part in the middle
  label: string;
  digits: number;        // of the bar's numbers in um
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const bar = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const table = parting ? kPartingTable : kViridisTable;
    canvas.current?.getContext("2d")?.putImageData(pictureOf(values, width, height, range ?? kAny, table), 0, 0);
    const context = bar.current?.getContext("2d");
    for (let i = 0; context && i < kBar_px; ++i) {
      context.fillStyle = cssColour(table[i] ?? 0);
      context.fillRect(i, 0, 1, 16);
    }
  }, [values, range?.low, range?.high, parting]);
  return html`<figure class="map-picture">
    <canvas ref=${canvas} width=${width} height=${height} role="img" aria-label=${label}></canvas>
    ${range && html`<div class="bar-of-colours"><span>${number(range.low * 1e6, digits)}</span><canvas ref=${bar} width=${kBar_px} height="16" aria-hidden="true"></canvas><span>${number(range.high * 1e6, digits)} µm</span></div>`}
    <figcaption>${label}</figcaption>
  </figure>`;
}
