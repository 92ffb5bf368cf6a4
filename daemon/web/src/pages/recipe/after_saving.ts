// A recipe was saved: that it was, and the ways to measure by it.
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { go } from "../../lib/router.ts";
import { recipeChoice } from "../run/run_state.ts";
import { PrepareButton } from "./prepare_button.ts";

export function AfterSaving({ id, version }: { id: string; version: number }) {
  return html`<section class="panel saved" aria-label=${t("recipe.saved_as", { version })}>
    <p role="status"><strong>● ${t("recipe.saved_as", { version })}</strong></p>
    <p class="buttons">
      <button type="button" class="main" onClick=${() => {
        recipeChoice.set(id);
        go("/");
      }}>${t("recipe.run_it")}</button>
      <${PrepareButton} id=${id} help=${t("recipe.prepare_help")}/>
    </p>
  </section>`;
}
