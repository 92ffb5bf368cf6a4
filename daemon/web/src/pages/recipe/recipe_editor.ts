// The editor: form at one side; text, differences, map, trial and versions at the other; both of one document.
import { useEffect, useMemo, useState } from "preact/hooks";
import { t, type TextKey } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { differences } from "../../recipe/difference.ts";
import { type Draft, dropDraft, keepDraft } from "../../recipe/draft.ts";
import type { Json } from "../../recipe/schema.ts";
import { StopButton } from "./assistant/stop_button.ts";
import { CheckState } from "./check_state.ts";
import { DifferenceList } from "./difference_list.ts";
import { useEditor } from "./editor.ts";
import { useNewestJob } from "./newest_job.ts";
import { RawJson } from "./raw_json.ts";
import { RecipeActions } from "./recipe_actions.ts";
import { RecipeForm } from "./recipe_form.ts";
import type { Saved } from "./recipe_page.ts";
import { RegionMap } from "./region_map.ts";
import { SaveBar } from "./save_bar.ts";
import { TryPanel } from "./try_panel.ts";
import { VersionList } from "./version_list.ts";

const kViews = ["text", "map", "try", "difference", "versions"] as const;
type View = (typeof kViews)[number];

const parsed = (text: string): Json | undefined => {
  try {
    return JSON.parse(text) as Json;
  } catch {
    return undefined;
  }
};

export function RecipeEditor({ id, saved, draft, onSaved, onDiscard }: {
  id: string;
  saved: Saved;
  draft: Draft | null;
  onSaved: (version: number) => void;
  onDiscard: () => void;
}) {
  const editor = useEditor(id, draft?.text ?? saved.text);
  const base = draft?.base_version ?? saved.version;
  const [view, setView] = useState<View>("text");
  const [place, setPlace] = useState<{ pointer: string; count: number }>({ pointer: "", count: 0 });
  const newest = useNewestJob(id);
  const before = useMemo(() => parsed(saved.text), [saved.text]);
  const changes = useMemo(() => (editor.document === null ? null : differences(before, editor.document)), [before, editor.document]);
  const isChanged = editor.text !== saved.text && (changes === null || changes.length > 0);

  useEffect(() => {
    if (isChanged) keepDraft(id, { text: editor.text, base_version: base });
    else dropDraft(id);
  }, [id, editor.text, isChanged, base]);

  // A problem leads to its field; where the form has none, to its place in the text.
  const show = (pointer: string): void => {
    setView("text");
    setPlace({ pointer, count: place.count + 1 });
  };
  return html`
    ${draft && isChanged && html`<p class="panel notice">${t("recipe.draft_found")}</p>`}
    ${draft && draft.base_version !== saved.version && html`<p role="alert" class="problem">${t("recipe.draft_old", { base: draft.base_version, version: saved.version })}</p>`}
    <${SaveBar} editor=${editor} base=${base} isChanged=${isChanged} onSaved=${onSaved} onDiscard=${onDiscard}/>
    <${CheckState} editor=${editor} onShow=${show}/>
    <div class="recipe-columns">
      <div><${RecipeForm} editor=${editor}/></div>
      <div class="recipe-side">
        <div class="views" role="group" aria-label=${t("recipe.views")}>
          ${kViews.map((each) => html`<button type="button" aria-pressed=${view === each ? "true" : "false"} onClick=${() => setView(each)}>
            ${t(`recipe.view_${each}` as TextKey)}${each === "difference" && changes?.length ? ` (${changes.length})` : ""}</button>`)}
        </div>
        <section class="panel" aria-label=${t(`recipe.view_${view}` as TextKey)}>
          ${view === "text" && html`<${RawJson} editor=${editor} place=${place}/>`}
          ${view === "map" && html`<${RegionMap} editor=${editor} newest=${newest}/>`}
          ${view === "try" && html`<${TryPanel} editor=${editor} newest=${newest}/>`}
          ${view === "difference" && html`<${DifferenceList} changes=${changes}/>`}
          ${view === "versions" && html`<${VersionList} id=${id} version=${saved.version} isChanged=${isChanged} onRestored=${onSaved}/>`}
        </section>
        <${RecipeActions} editor=${editor} version=${saved.version} isChanged=${isChanged}/>
      </div>
    </div>
    <div class="stop-line"><${StopButton}/></div>`;
}
