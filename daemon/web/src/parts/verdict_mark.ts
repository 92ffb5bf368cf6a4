// A verdict as shape, colour and word: never by colour alone.
import { t, tWord } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";

const kShapes: Record<string, string> = { pass: "●", fail: "■", uncertain: "▲", invalid: "✕" };

export function VerdictMark({ verdict }: { verdict: string | null }) {
  if (verdict === null || !Object.hasOwn(kShapes, verdict)) return html`<span class="verdict none">${t("verdict.none")}</span>`;
  return html`<span class="verdict ${verdict}"><span aria-hidden="true">${kShapes[verdict]}</span> ${tWord("verdict", verdict)}</span>`;
}
