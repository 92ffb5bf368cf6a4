import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";

export function RecipeListPage() {
  useLanguage();
  return html`<h1>${t("nav.recipes")}</h1>`;
}
