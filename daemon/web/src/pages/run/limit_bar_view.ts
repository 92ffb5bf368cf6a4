// A value in its limits as a picture: the allowed zone, the interval of value and U, the value.
import { number, t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { limitBar } from "../../run/limit_bar.ts";
import type { ValueRow } from "../../run/value_rows.ts";

const kWidth = 200;
const kHeight = 28;

// A limit has the digits that it was written with: it must not look like another one.
export function limitsText({ lower, upper }: ValueRow, unit: string): string {
  const of = (value: number): string => `${number(value)}${unit && ` ${unit}`}`;
  if (lower !== null && upper !== null) return t("run.limits_both", { lower: of(lower), upper: of(upper) });
  if (lower !== null) return t("run.limits_lower", { lower: of(lower) });
  if (upper !== null) return t("run.limits_upper", { upper: of(upper) });
  return t("run.limits_none");
}

export function LimitBarView({ row, label }: { row: ValueRow; label: string }) {
  const bar = limitBar(row.value, row.U, row.lower, row.upper);
  if (!bar) return null;
  const x = (share: number): number => share * kWidth;
  const begin = bar.lower === null ? 0 : x(bar.lower);
  const end = bar.upper === null ? kWidth : x(bar.upper);
  const verdict = row.verdict ?? "none";
  return html`<svg class="limit-bar" viewBox=${`-6 0 ${kWidth + 12} ${kHeight}`} role="img" aria-label=${label}>
    <line class="axis" x1="0" y1="14" x2=${kWidth} y2="14"/>
    <rect class="allowed" x=${begin} y="8" width=${Math.max(0, end - begin)} height="12"/>
    ${[bar.lower, bar.upper].map((limit) => limit !== null && html`<line class="limit" x1=${x(limit)} y1="3" x2=${x(limit)} y2="25"/>`)}
    ${bar.to > bar.from && html`<path class=${`interval verdict-${verdict}`} d=${`M${x(bar.from)} 14H${x(bar.to)}M${x(bar.from)} 9v10M${x(bar.to)} 9v10`}/>`}
    ${bar.beyond === "no"
      ? html`<circle class=${`value verdict-${verdict}`} cx=${x(bar.value)} cy="14" r="5"/>`
      : html`<path class=${`value verdict-${verdict}`} d=${bar.beyond === "below" ? "M-5 14 5 8v12Z" : `M${kWidth + 5} 14l-10-6v12Z`}/>`}
  </svg>`;
}
