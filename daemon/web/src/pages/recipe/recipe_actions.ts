// What is done with a whole recipe: to prepare it for jobs, to export, import and duplicate it.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { go } from "../../lib/router.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { freeId, isId } from "../../recipe/ids.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { download } from "../../lib/download.ts";
import type { Editor } from "./editor.ts";
import { justSaved } from "./just_saved.ts";
import { PrepareButton } from "./prepare_button.ts";

export function RecipeActions({ editor, version, isChanged }: { editor: Editor; version: number; isChanged: boolean }) {
  const { who, role } = useStore(session);
  const [problem, setProblem] = useState("");
  const [copy, setCopy] = useState("");

  const duplicate = async (): Promise<void> => {
    const list = (await call("recipe.list", {})).recipes as string[];
    const id = copy.trim() || freeId(editor.id, list);
    if (!isId(id)) throw new Error(t("recipe.bad_id"));
    if (list.includes(id)) throw new Error(t("recipe.id_taken", { id }));
    const saved = await call("recipe.save", { id, text: editor.text, base_version: 0, author: who, comment: t("recipe.copied_from", { id: editor.id, version }) });
    justSaved.set({ id, version: saved.version });
    go(`/recipes/${encodeURIComponent(id)}`);
  };
  const take = async (event: Event): Promise<void> => {
    const input = event.target as HTMLInputElement;
    const file = input.files?.[0];
    if (file) editor.setText(await file.text());
    input.value = "";
  };
  return html`<section class="panel" aria-labelledby="recipe-actions">
    <h2 id="recipe-actions">${t("recipe.actions")}</h2>
    <p class="buttons"><${PrepareButton} id=${editor.id} help=${t(isChanged ? "recipe.prepare_saved" : "recipe.prepare_help")}/></p>
    <p class="buttons">
      <button type="button" onClick=${() => download(`${editor.id}.json`, "application/json", editor.text)}>${t("recipe.export")}</button>
      <label class="button">${t("recipe.import_here")} <input type="file" accept=".json,application/json" onChange=${(event: Event) => void take(event)}/></label>
    </p>
    <p class="add">
      <label>${t("recipe.copy_id")} <input value=${copy} maxlength="32" autocomplete="off" onInput=${(event: Event) => setCopy((event.target as HTMLInputElement).value)}/></label>
      <button type="button" disabled=${!mayAs(role, "set_up") || !editor.check?.accepted} onClick=${() => {
        setProblem("");
        duplicate().catch((error: unknown) => setProblem(messageOf(error)));
      }}>${t("recipe.duplicate")}</button>
    </p>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
  </section>`;
}
