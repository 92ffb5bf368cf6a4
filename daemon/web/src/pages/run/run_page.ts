import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";

export function RunPage() {
  useLanguage();
  return html`<h1>${t("nav.run")}</h1>`;
}
