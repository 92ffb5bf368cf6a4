// A verdict as a word and a shape of its own: never by colour alone.
import { tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { Verdict } from "../../result/result_json.ts";

function shape(verdict: string) {
  switch (verdict) {
    case "pass": return html`<circle cx="12" cy="12" r="9"/>`;
    case "fail": return html`<rect x="4" y="4" width="16" height="16"/>`;
    case "uncertain": return html`<path d="M12 3 22 21H2Z"/>`;
    case "invalid": return html`<path d="M4 4 20 20M20 4 4 20" fill="none" stroke="currentColor" stroke-width="4"/>`;
    default: return html`<path d="M5 12H19" fill="none" stroke="currentColor" stroke-width="3"/>`;
  }
}

export const verdictText = (verdict: Verdict | null | undefined): string => tWord("result.verdict", verdict ?? "none");

export function VerdictSign({ verdict, large = false }: { verdict: Verdict | null | undefined; large?: boolean }) {
  const size = large ? 32 : 18;
  return html`<span class=${`result-verdict is-${verdict ?? "none"}${large ? " is-large" : ""}`}>
    <svg width=${size} height=${size} viewBox="0 0 24 24" fill="currentColor" aria-hidden="true">${shape(verdict ?? "none")}</svg>
    <span>${verdictText(verdict)}</span>
  </span>`;
}
