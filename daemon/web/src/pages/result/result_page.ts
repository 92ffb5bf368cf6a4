import { useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";

export function ResultPage({ id }: { id: string }) {
  useLanguage();
  return html`<h1>${id}</h1>`;
}
