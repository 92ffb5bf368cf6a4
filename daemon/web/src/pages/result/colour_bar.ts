// Which colour is which value; of holes, which colour is which reason, with how many points have it.
import { useEffect, useRef } from "preact/hooks";
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { type Range, cssColour, kGreyTable, kHoleColour, kViridisTable, rgba } from "../../surface/colours.ts";
import type { Kind } from "../../surface/height_tile.ts";
import { kHoleReasons } from "../../surface/hole_reasons.ts";
import { kValidColour } from "../../surface/paint.ts";
import { ticks } from "../../surface/ticks.ts";

const swatch = (colour: number) => html`<svg class="swatch" width="18" height="18" aria-hidden="true"><rect width="18" height="18" fill=${cssColour(colour)}/></svg>`;

export function HoleLegend({ counts, points }: { counts: Record<string, number>; points: number }) {
  const present = kHoleReasons.filter(({ name }) => (counts[name] ?? 0) > 0);
  return html`<ul class="hole-legend" aria-label=${t("result.holes.legend")}>
    <li>${swatch(kValidColour)} ${t("result.readout.valid")}</li>
    ${present.map(({ name, colour }) => html`<li>${swatch(colour)} ${tWord("result.reason", name)}: ${number(counts[name] ?? 0)}${
      points > 0 && ` (${number(((counts[name] ?? 0) / points) * 100, 2)} %)`}</li>`)}
    ${present.length === 0 && html`<li>${t("result.holes.none")}</li>`}
  </ul>`;
}

// range in the unit that is shown.
export function ColourBar({ kind, range, unit }: { kind: Kind; range: Range; unit: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const table = kind === "texture" ? kGreyTable : kViridisTable;
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context) return;
    const image = new ImageData(256, 1);
    new Uint32Array(image.data.buffer).set(table.map(rgba));
    context.putImageData(image, 0, 0);
  }, [table]);
  const { values, digits } = ticks(range.low, range.high, 7);
  const at = (value: number): number => (range.high > range.low ? ((value - range.low) / (range.high - range.low)) * 100 : 50);
  return html`<div class="colour-bar">
    <canvas ref=${canvas} width="256" height="1" role="img"
      aria-label=${t("result.bar", { low: number(range.low, digits + 1), high: number(range.high, digits + 1), unit })}></canvas>
    <div class="colour-bar-ticks" aria-hidden="true">
      ${values.map((value) => html`<span style=${{ left: `${at(value)}%` }}>${number(value, digits)}</span>`)}
    </div>
    <p class="help">${tWord("result.kind", kind)}${unit && ` / ${unit}`}${kind !== "texture" && html` · ${swatch(kHoleColour)} ${t("result.hole")}`}</p>
  </div>`;
}
