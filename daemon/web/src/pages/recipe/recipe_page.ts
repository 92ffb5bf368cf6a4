// One recipe: loaded, then edited.
import { useEffect, useState } from "preact/hooks";
import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { type Draft, dropDraft, readDraft } from "../../recipe/draft.ts";
import { call } from "../../rpc/rpc.ts";
import { AfterSaving } from "./after_saving.ts";
import { justSaved } from "./just_saved.ts";
import { RecipeEditor } from "./recipe_editor.ts";
import "../../style/recipe.css";

export interface Saved {
  version: number;
  text: string;
}

export function RecipePage({ id }: { id: string }) {
  useLanguage();
  const [saved, setSaved] = useState<Saved | null>(null);
  const [draft, setDraft] = useState<Draft | null>(null);
  const [problem, setProblem] = useState("");
  const [said, setSaid] = useState("");
  // Counts loads, so that an editor begins anew with what was loaded.
  const [load, setLoad] = useState(0);

  const done = useStore(justSaved);
  // Whoever comes again later finds the recipe, not news of long ago.
  useEffect(() => () => {
    if (justSaved.get()?.id === id) justSaved.set(null);
  }, [id]);

  useEffect(() => {
    let ended = false;
    call("recipe.get", { id }).then(
      ({ version, text }) => {
        if (ended) return;
        setDraft(readDraft(id));
        setSaved({ version, text });
        setProblem("");
      },
      (error) => { if (!ended) setProblem(messageOf(error)); },
    );
    return () => { ended = true; };
  }, [id, load]);

  const again = (text: string): void => {
    justSaved.set(null);
    setSaid(text);
    dropDraft(id);
    setSaved(null);
    setLoad(load + 1);
  };
  return html`<h1>${t("recipe.title", { id })}</h1>
    <p><a href="/recipes">${t("recipe.back")}</a></p>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    <p aria-live="polite">${said}</p>
    ${done?.id === id && html`<${AfterSaving} id=${id} version=${done.version}/>`}
    ${saved && html`<${RecipeEditor} key=${load} id=${id} saved=${saved} draft=${draft} onSaved=${(version: number) => {
      again("");
      justSaved.set({ id, version });
    }} onDiscard=${() => again(t("recipe.discarded"))}/>`}
    ${!saved && !problem && html`<p>${t("recipe.loading")}</p>`}`;
}
