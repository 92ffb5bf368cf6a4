// The sharpness over z, with the range of the scan in it.
import { number, t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import type { CurvePoint, Scan } from "../../../recipe/suggest.ts";

const kWidth = 600;
const kHeight = 160;
const kFoot = 22;

export function FocusCurvePicture({ points, scan }: { points: readonly CurvePoint[]; scan: Scan | null }) {
  const curve = [...points].sort((a, b) => a[0] - b[0]);
  const end = scan ? scan.start_um + scan.step_um * (scan.slices - 1) : NaN;
  const all = [...curve.map(([z]) => z), ...(scan ? [scan.start_um, end] : [])];
  const [from, to] = [Math.min(...all), Math.max(...all)];
  const top = Math.max(...curve.map(([, value]) => value)) || 1;
  const x = (z: number): number => ((z - from) / (to - from || 1)) * kWidth;
  const y = (value: number): number => kHeight - (value / top) * (kHeight - 8);
  return html`<svg class="focus-curve" viewBox=${`0 0 ${kWidth} ${kHeight + kFoot}`} role="img" aria-label=${t("recipe.curve_label", { count: curve.length })}>
    ${scan && html`<rect class="range" x=${x(scan.start_um)} y="0" width=${Math.max(1, x(end) - x(scan.start_um))} height=${kHeight}/>`}
    <polyline points=${curve.map(([z, value]) => `${x(z).toFixed(1)},${y(value).toFixed(1)}`).join(" ")}/>
    ${curve.map(([z, value]) => html`<circle cx=${x(z)} cy=${y(value)} r="3"/>`)}
    <text x="0" y=${kHeight + 18}>${number(Math.round(from))} µm</text>
    <text x=${kWidth} y=${kHeight + 18} text-anchor="end">${number(Math.round(to))} µm</text>
  </svg>`;
}
