// A verdict's shape: circle, square, triangle, cross; a dash where nothing was judged. The word always stands beside it.
import { tWord } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import type { Verdict } from "../run/value_rows.ts";

const kShapes = {
  pass: () => html`<circle cx="12" cy="12" r="9"/>`,
  fail: () => html`<rect x="4" y="4" width="16" height="16"/>`,
  uncertain: () => html`<path d="M12 3 22 21H2Z"/>`,
  invalid: () => html`<path d="M4 4 20 20M20 4 4 20" fill="none" stroke="currentColor" stroke-width="4"/>`,
  none: () => html`<path d="M5 12H19" fill="none" stroke="currentColor" stroke-width="3"/>`,
} as const;

const nameOf = (verdict: string | null | undefined): keyof typeof kShapes =>
  verdict != null && Object.hasOwn(kShapes, verdict) ? (verdict as Verdict) : "none";

export function VerdictMark({ verdict, size = 20 }: { verdict: string | null; size?: number }) {
  const name = nameOf(verdict);
  return html`<svg class=${`verdict-mark verdict-${name}`} width=${size} height=${size} viewBox="0 0 24 24" fill="currentColor" aria-hidden="true">${kShapes[name]()}</svg>`;
}

export const verdictWord = (verdict: string | null | undefined): string => tWord("verdict", nameOf(verdict));

export function VerdictLabel({ verdict, size = 20 }: { verdict: string | null | undefined; size?: number }) {
  return html`<span class=${`verdict verdict-${nameOf(verdict)}`}><${VerdictMark} verdict=${verdict ?? null} size=${size}/> ${verdictWord(verdict)}</span>`;
}
