// Which result is meant, and the way to another one.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { tryId } from "../../recipe/ids.ts";
import type { Newest } from "./newest_job.ts";

export function JobChoice({ newest, recipe }: { newest: Newest; recipe: string }) {
  const [typed, setTyped] = useState("");
  return html`
    ${newest.job_id
      ? html`<p>${t("recipe.of_job")} <a href=${`/jobs/${encodeURIComponent(newest.job_id)}`}>${newest.job_id}</a>
          ${newest.recipe && newest.recipe !== recipe && newest.recipe !== tryId(recipe) && html` – <strong>${t("recipe.of_other", { recipe: newest.recipe })}</strong>`}</p>`
      : html`<p>${t("recipe.no_job")}</p>`}
    ${newest.problem && html`<p role="alert" class="problem">${newest.problem}</p>`}
    <form class="add" onSubmit=${(event: Event) => {
      event.preventDefault();
      newest.choose(typed.trim());
    }}>
      <label>${t("recipe.other_job")} <input value=${typed} autocomplete="off" maxlength="64" onInput=${(event: Event) => setTyped((event.target as HTMLInputElement).value)}/></label>
      <button type="submit">${t("recipe.take_job")}</button>
    </form>`;
}
