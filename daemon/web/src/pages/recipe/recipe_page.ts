import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";

export function RecipePage({ id }: { id: string }) {
  useLanguage();
  return html`<h1>${t("nav.recipes")}: ${id}</h1>`;
}
