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

export function VerdictMark({ verdict, size = 20 }: { verdict: Verdict | null; size?: number }) {
  const name = verdict ?? "none";
  return html`<svg class=${`verdict-mark verdict-${name}`} width=${size} height=${size} viewBox="0 0 24 24" fill="currentColor" aria-hidden="true">${kShapes[name]()}</svg>`;
}

export const verdictWord = (verdict: Verdict | null): string => tWord("run.verdict", verdict ?? "none");

export function VerdictLabel({ verdict, size = 20 }: { verdict: Verdict | null; size?: number }) {
  return html`<span class=${`verdict verdict-${verdict ?? "none"}`}><${VerdictMark} verdict=${verdict} size=${size}/> ${verdictWord(verdict)}</span>`;
}
