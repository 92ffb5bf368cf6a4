// A curve with its axes' ends and a mark: for what one reads at a glance. The numbers are in a table for who cannot see it.
import { number, t, useLanguage } from "../../i18n/i18n.ts";
import { usefulDigits } from "../../lib/digits.ts";
import { html } from "../../lib/html.ts";

interface Props {
  points: [number, number][];
  mark?: number | undefined;  // an x
  x: string;
  y: string;
}

const kWidth = 320;
const kHeight = 140;

export function LinePlot({ points, mark, x, y }: Props) {
  useLanguage();
  const xs = points.map(([value]) => value);
  const ys = points.map(([, value]) => value);
  const [left, right] = [Math.min(...xs), Math.max(...xs)];
  const [low, high] = [Math.min(...ys), Math.max(...ys)];
  const atX = (value: number): number => ((value - left) / (right - left || 1)) * kWidth;
  const atY = (value: number): number => kHeight - 4 - ((value - low) / (high - low || 1)) * (kHeight - 8);
  const told = (value: number): string => number(value, usefulDigits(value, 3));
  return html`<figure class="plot">
    <svg viewBox=${`0 0 ${kWidth} ${kHeight}`} role="img" aria-label=${`${y} / ${x}: ${told(low)} – ${told(high)}`} preserveAspectRatio="none">
      ${mark !== undefined && html`<line class="mark" x1=${atX(mark)} x2=${atX(mark)} y1="0" y2=${kHeight}/>`}
      <polyline class="curve" points=${points.map(([px, py]) => `${atX(px).toFixed(1)},${atY(py).toFixed(1)}`).join(" ")}/>
    </svg>
    <figcaption><span>${told(left)}</span><span>${x}</span><span>${told(right)}</span></figcaption>
    <details><summary>${t("setup.plot.table")}</summary>
      <div class="scroll tall" tabindex="0" role="group" aria-label=${t("setup.plot.table")}><table>
        <tr><th scope="col" class="number">${x}</th><th scope="col" class="number">${y}</th></tr>
        ${points.map(([px, py]) => html`<tr><td class="number">${told(px)}</td><td class="number">${told(py)}</td></tr>`)}
      </table></div>
    </details>
  </figure>`;
}
