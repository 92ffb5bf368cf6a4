// The way to a new recipe, from the live picture to a name. Every step can be taken again; the draft is one document as in the editor.
import { useEffect, useState } from "preact/hooks";
import { t, type TextKey } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { dropDraft, keepDraft, readDraft } from "../../../recipe/draft.ts";
import { formatJson } from "../../../recipe/format_json.ts";
import { kNewRecipe } from "../../../recipe/kinds.ts";
import { CheckState } from "../check_state.ts";
import { type Editor, useEditor } from "../editor.ts";
import { type Newest, useNewestJob } from "../newest_job.ts";
import { RegionMap } from "../region_map.ts";
import { RawJson } from "../raw_json.ts";
import { tryId } from "../../../recipe/ids.ts";
import { FocusStep } from "./focus_step.ts";
import { LimitStep } from "./limit_step.ts";
import { MeasurementStep } from "./measurement_step.ts";
import { NameStep } from "./name_step.ts";
import { PictureStep } from "./picture_step.ts";
import { StopButton } from "./stop_button.ts";
import { TrialStep } from "./trial_step.ts";

export interface StepProps {
  editor: Editor;
  newest: Newest;  // the result of the newest trial
  taken: readonly string[];
}

const kSteps = [
  ["picture", PictureStep],
  ["focus", FocusStep],
  ["trial", TrialStep],
  ["regions", ({ editor, newest }: StepProps) => html`<${RegionMap} editor=${editor} newest=${newest}/>`],
  ["measurements", MeasurementStep],
  ["limits", LimitStep],
  ["name", NameStep],
] as const;

// The id of a draft that has no name yet.
export const kDraft = "new";

export function Assistant({ taken }: { taken: readonly string[] }) {
  const [kept] = useState(() => readDraft(kDraft));
  const initial = kept?.text ?? formatJson(kNewRecipe);
  const editor = useEditor(kDraft, initial);
  const newest = useNewestJob(tryId(kDraft));
  const [step, setStep] = useState(() => Math.max(0, Math.min(kSteps.length - 1, kept?.step ?? 0)));
  const [goesOn, setGoesOn] = useState(kept !== null && (kept.text !== formatJson(kNewRecipe) || step > 0));
  useEffect(() => keepDraft(kDraft, { text: editor.text, base_version: 0, step }), [editor.text, step]);
  const current = kSteps[step] ?? kSteps[0];
  const go = (to: number): void => {
    setStep(to);
    setGoesOn(false);
    // The heading tells where one is now.
    requestAnimationFrame(() => document.getElementById("assistant-step")?.focus());
  };
  return html`<div class="assistant">
    <h1>${t("recipe.assistant")}</h1>
    <p><a href="/recipes">${t("recipe.back")}</a></p>
    ${goesOn && html`<p class="panel notice">${t("recipe.assistant_goes_on")}</p>`}
    <ol class="steps views">${kSteps.map(([name], i) => html`<li key=${name}>
      <button type="button" aria-current=${i === step ? "step" : undefined} aria-pressed=${i === step ? "true" : "false"} onClick=${() => go(i)}>
        ${i + 1}. ${t(`recipe.step_${name}` as TextKey)}</button></li>`)}</ol>
    <section class="panel" aria-labelledby="assistant-step">
      <h2 id="assistant-step" tabindex="-1">${t("recipe.step_of", { number: step + 1, of: kSteps.length })}: ${t(`recipe.step_${current[0]}` as TextKey)}</h2>
      <p class="help">${t(`recipe.step_${current[0]}_help` as TextKey)}</p>
      <${current[1]} key=${current[0]} editor=${editor} newest=${newest} taken=${taken}/>
      <p class="buttons">
        <button type="button" disabled=${step === 0} onClick=${() => go(step - 1)}>${t("recipe.step_back")}</button>
        <button type="button" class="main" disabled=${step === kSteps.length - 1} onClick=${() => go(step + 1)}>${t("recipe.step_next")}</button>
        <button type="button" onClick=${() => {
          dropDraft(kDraft);
          editor.setText(formatJson(kNewRecipe));
          go(0);
        }}>${t("recipe.step_anew")}</button>
      </p>
    </section>
    <${CheckState} editor=${editor} onShow=${() => undefined}/>
    <details class="panel assistant-text"><summary>${t("recipe.text_label")}</summary><${RawJson} editor=${editor} place=${{ pointer: "", count: 0 }}/></details>
    <div class="stop-line"><${StopButton}/></div>
  </div>`;
}
