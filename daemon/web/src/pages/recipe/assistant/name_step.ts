// The recipe's name, and who made it: then it is a recipe.
import { useState } from "preact/hooks";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { go } from "../../../lib/router.ts";
import { useStore } from "../../../lib/store.ts";
import { dropDraft } from "../../../recipe/draft.ts";
import { isId } from "../../../recipe/ids.ts";
import { recipeSchema } from "../../../recipe/schema.ts";
import { call } from "../../../rpc/rpc.ts";
import { session } from "../../../rpc/session.ts";
import { justSaved } from "../just_saved.ts";
import { Field } from "../fields/field.ts";
import { type StepProps, kDraft } from "./assistant.ts";
import { useRun } from "./run.ts";

export function NameStep({ editor, taken }: StepProps) {
  const { who } = useStore(session);
  const [typed, setTyped] = useState("");
  const [author, setAuthor] = useState<string | null>(null);
  const { why, run, view } = useRun();
  const id = typed.trim();
  const name = author ?? who;
  const whyNot = why || (!editor.check?.accepted || !editor.isChecked ? t("recipe.save_refused")
    : !isId(id) ? t("recipe.bad_id") : taken.includes(id) ? t("recipe.id_taken", { id }) : name.trim() === "" ? t("recipe.needs_author") : "");
  const save = async (): Promise<void> => {
    const { version } = await call("recipe.save", { id, text: editor.text, base_version: 0, author: name.trim(), comment: t("recipe.made_by_assistant") });
    dropDraft(kDraft);
    justSaved.set({ id, version });
    go(`/recipes/${encodeURIComponent(id)}`);
  };
  return html`
    <${Field} editor=${editor} schema=${recipeSchema.properties?.["description"] ?? {}} path=${["description"]} required=${false}/>
    <div class="add">
      <label>${t("recipe.name")} <input value=${typed} maxlength="32" autocomplete="off" aria-describedby="name-why" onInput=${(event: Event) => setTyped((event.target as HTMLInputElement).value)}/></label>
      <label>${t("recipe.author")} <input value=${name} maxlength="64" autocomplete="name" onInput=${(event: Event) => setAuthor((event.target as HTMLInputElement).value)}/></label>
      <button type="button" class="main" disabled=${whyNot !== ""} onClick=${() => run(t("recipe.saving"), save)}>${t("recipe.save_new")}</button>
    </div>
    <p class="help" id="name-why">${why === "" ? whyNot : ""}</p>
    ${view}`;
}
