// A curve as small as a word.
import { number, t } from "../../../i18n/i18n.ts";
import { usefulDigits } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { pathOf } from "./sparkline_path.ts";

const kWidth = 120;
const kHeight = 28;

export function Sparkline({ points, label }: { points: [number, number][]; label: string }) {
  if (points.length < 2) return html`<span class="sparkline help">${t("setup.metrics.wait")}</span>`;
  const ys = points.map(([, y]) => y);
  const told = (value: number): string => number(value, usefulDigits(value, 3));
  return html`<svg class="sparkline" viewBox=${`0 0 ${kWidth} ${kHeight}`} role="img" preserveAspectRatio="none"
    aria-label=${t("setup.metrics.range", { name: label, low: told(Math.min(...ys)), high: told(Math.max(...ys)) })}>
    <polyline class="curve" points=${pathOf(points, kWidth, kHeight)}/>
  </svg>`;
}
