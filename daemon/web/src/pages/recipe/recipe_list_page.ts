// All recipes, and the ways to a new one.
import { useEffect, useState } from "preact/hooks";
import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { go, place } from "../../lib/router.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { freeId, idFrom, isTryId } from "../../recipe/ids.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { Assistant } from "./assistant/assistant.ts";
import "../../style/recipe.css";

interface Entry {
  id: string;
  edited: boolean;
  version: number;
  error?: string;
  error_message?: string;
}

export function RecipeListPage() {
  useLanguage();
  const { who, role } = useStore(session);
  const { query } = useStore(place);
  const [entries, setEntries] = useState<Entry[] | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    call("recipe.list", {}).then(
      (answer) => setEntries(answer.entries as Entry[]),
      (error) => setProblem(messageOf(error)),
    );
  }, []);
  if (query.has("new")) return html`<${Assistant} taken=${entries?.map(({ id }) => id) ?? []}/>`;
  const may = mayAs(role, "set_up");

  const take = async (event: Event): Promise<void> => {
    const input = event.target as HTMLInputElement;
    const file = input.files?.[0];
    input.value = "";
    if (!file) return;
    try {
      const text = await file.text();
      const id = freeId(idFrom(file.name), entries?.map((each) => each.id) ?? []);
      await call("recipe.save", { id, text, base_version: 0, author: who, comment: t("recipe.imported_from", { name: file.name }) });
      go(`/recipes/${encodeURIComponent(id)}`);
    } catch (error) {
      setProblem(messageOf(error));
    }
  };
  return html`<h1>${t("nav.recipes")}</h1>
    ${problem && html`<p role="alert" class="problem recipe-lines">${problem}</p>`}
    <p class="buttons">
      <a class="button" href="/recipes?new">${t("recipe.new")}</a>
      <label class=${may ? "button" : "button off"}>${t("recipe.import")} <input type="file" accept=".json,application/json" disabled=${!may} onChange=${(event: Event) => void take(event)}/></label>
    </p>
    ${!may && html`<p class="help">${t("recipe.needs_set_up")}</p>`}
    <div class="scroll"><table class="recipe-list">
      <thead><tr><th>${t("recipe.id")}</th><th class="number">${t("recipe.version")}</th><th>${t("recipe.kind")}</th></tr></thead>
      <tbody>${entries?.map((each) => html`<tr key=${each.id}>
        <td><a class="row-link" href=${`/recipes/${encodeURIComponent(each.id)}`}>${each.id}</a></td>
        <td class="number">${each.version}</td>
        <td>${isTryId(each.id) ? t("recipe.kind_try") : each.version === 0 ? t("recipe.kind_shipped") : each.edited ? t("recipe.kind_edited") : t("recipe.kind_own")}
          ${each.error_message && html`<p class="problem">⚠ <span lang="en">${each.error_message}</span></p>`}</td>
      </tr>`)}</tbody>
    </table></div>`;
}
