// Saves the document as the recipe's next version, and says why it cannot be saved.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { RpcError, call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { differences } from "../../recipe/difference.ts";
import { dropDraft, keepDraft } from "../../recipe/draft.ts";
import type { Json } from "../../recipe/schema.ts";
import { DifferenceList } from "./difference_list.ts";
import type { Editor } from "./editor.ts";

const kConflict = 1017;

export function SaveBar({ editor, base, isChanged, onSaved, onDiscard }: {
  editor: Editor;
  base: number;
  isChanged: boolean;
  onSaved: (version: number) => void;
  onDiscard: () => void;
}) {
  const { who, role } = useStore(session);
  const [author, setAuthor] = useState<string | null>(null);
  const [comment, setComment] = useState("");
  const [base_version, setBase] = useState(base);
  const [problem, setProblem] = useState("");
  const [theirs, setTheirs] = useState<{ version: number; text: string } | null>(null);  // what is in force meanwhile
  const [busy, setBusy] = useState(false);
  const name = author ?? who;

  const why = !mayAs(role, "set_up") ? t("recipe.needs_set_up")
    : !isChanged ? t("recipe.no_difference")
    : !editor.isChecked ? t("recipe.checking")
    : !editor.check?.accepted ? t("recipe.save_refused")
    : name.trim() === "" ? t("recipe.needs_author") : "";

  const save = async (from: number): Promise<void> => {
    setBusy(true);
    setProblem("");
    try {
      const { version } = await call("recipe.save", { id: editor.id, text: editor.text, base_version: from, author: name.trim(), comment: comment.trim() });
      dropDraft(editor.id);
      onSaved(version);
    } catch (error) {
      if (error instanceof RpcError && error.code === kConflict) {
        setTheirs(await call("recipe.get", { id: editor.id }).then(({ version, text }) => ({ version, text }), () => ({ version: -1, text: "" })));
      }
      setProblem(messageOf(error));
    }
    setBusy(false);
  };
  return html`<div class="save-bar panel">
    <label>${t("recipe.author")} <input value=${name} maxlength="64" dir="auto" autocomplete="name" onInput=${(event: Event) => setAuthor((event.target as HTMLInputElement).value)}/></label>
    <label>${t("recipe.comment")} <input value=${comment} maxlength="200" dir="auto" onInput=${(event: Event) => setComment((event.target as HTMLInputElement).value)}/></label>
    <button type="button" class="main" disabled=${busy || why !== ""} aria-describedby="save-why" onClick=${() => void save(base_version)}>${t("recipe.save")}</button>
    <button type="button" disabled=${!isChanged} onClick=${onDiscard}>${t("recipe.discard")}</button>
    <span id="save-why" class="help">${why || t("recipe.from_version", { version: base_version })}</span>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${theirs && html`<div class="conflict">
      <p>${theirs.version < 0 ? t("recipe.conflict_unknown") : t("recipe.conflict", { base: base_version, version: theirs.version })}</p>
      ${theirs.version >= 0 && editor.document !== null && html`
        <p>${t("recipe.conflict_difference")}</p>
        <${DifferenceList} changes=${differences(JSON.parse(theirs.text) as Json, editor.document)}/>`}
      <p class="buttons">
        <button type="button" disabled=${theirs.version < 0 || why !== ""} onClick=${() => {
          keepDraft(editor.id, { text: editor.text, base_version: theirs.version });
          setBase(theirs.version);
          setTheirs(null);
          void save(theirs.version);
        }}>${t("recipe.conflict_mine")}</button>
        <button type="button" onClick=${onDiscard}>${t("recipe.conflict_theirs")}</button>
        <button type="button" onClick=${() => setTheirs(null)}>${t("recipe.conflict_look")}</button>
      </p>
    </div>`}
  </div>`;
}
