// A map as a picture with its bar of colours.
import { useEffect, useRef } from "preact/hooks";
import { number } from "../i18n/i18n.ts";
import { colourOf, paint } from "../lib/height_picture.ts";
import { html } from "../lib/html.ts";

const kBar_px = 256;

export function MapPicture({ values, width, height, range, parting, label, digits }: {
  values: Float32Array;  // metres
  width: number;
  height: number;
  range: { from: number; to: number };
  parting?: boolean;     // two colours that part in the middle
  label: string;
  digits: number;        // of the bar's numbers in um
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const bar = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    canvas.current?.getContext("2d")?.putImageData(paint(values, width, height, range, parting), 0, 0);
    const context = bar.current?.getContext("2d");
    for (let i = 0; context && i < kBar_px; ++i) {
      context.fillStyle = `rgb(${colourOf(i / (kBar_px - 1), parting).join()})`;
      context.fillRect(i, 0, 1, 16);
    }
  }, [values, range.from, range.to, parting]);
  return html`<figure class="map-picture">
    <canvas ref=${canvas} width=${width} height=${height} role="img" aria-label=${label}></canvas>
    <div class="bar-of-colours"><span>${number(range.from * 1e6, digits)}</span><canvas ref=${bar} width=${kBar_px} height="16" aria-hidden="true"></canvas><span>${number(range.to * 1e6, digits)} µm</span></div>
    <figcaption>${label}</figcaption>
  </figure>`;
}
