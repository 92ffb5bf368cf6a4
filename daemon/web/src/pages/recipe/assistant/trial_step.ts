// A scan by the draft as it is, and what to make of it.
import { number, t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { getAt } from "../../../recipe/document.ts";
import { type JsonObject, isObject } from "../../../recipe/schema.ts";
import { suggestWindow } from "../../../recipe/suggest.ts";
import { keepForTrial, pressed, scanBy } from "../../../recipe/try_recipe.ts";
import { session } from "../../../rpc/session.ts";
import type { StepProps } from "./assistant.ts";
import { useRun } from "./run.ts";

const kWindow = ["reconstruct", "focus", "window_px"] as const;

function Facts({ editor, result }: { editor: StepProps["editor"]; result: JsonObject }) {
  const values = result["values"];
  if (!isObject(values)) return null;
  const valid = Number(values["valid_fraction"]);
  const current = getAt(editor.document ?? undefined, kWindow);
  const window_px = typeof current === "number" ? current : 9;
  const wanted = suggestWindow(valid, window_px);
  const height = isObject(values["height"]) ? values["height"] : {};
  return html`<ul>
      <li>${t("recipe.trial_valid", { valid: number(100 * valid, 1) })}</li>
      <li>${t("recipe.trial_heights", { min: number(Number(height["min_um"]), 2), max: number(Number(height["max_um"]), 2) })}</li>
      <li>${t("recipe.trial_sigma", { sigma: number(Number(values["sigma_median_um"]), 3) })}</li>
      <li>${wanted === window_px ? t("recipe.window_good", { window: window_px }) : t("recipe.window_larger", { window: window_px, wanted })}
        ${wanted !== window_px && html` <button type="button" onClick=${() => editor.set(kWindow, wanted)}>${t("recipe.take_window", { wanted })}</button>`}</li>
    </ul>`;
}

export function TrialStep({ editor, newest }: StepProps) {
  const { who } = useStore(session);
  const { why, run, view } = useRun();
  const whyNot = why || (!editor.check?.accepted || !editor.isChecked ? t("recipe.save_refused") : "");
  const scan = async (say: (text: string) => void): Promise<void> => {
    const press = pressed();
    const trial = await keepForTrial(editor.id, editor.text, who);
    const { id } = await scanBy(trial, "trial", press, (progress) => say(t("recipe.scanning", { percent: Math.round(100 * progress) })));
    newest.choose(id);
  };
  return html`
    <p class="buttons"><button type="button" class="main" disabled=${whyNot !== ""} onClick=${() => run(t("recipe.trying"), scan)}>${t("recipe.trial_scan")}</button></p>
    <p class="help">${t("recipe.moves_stage")} ${why === "" ? whyNot : ""}</p>
    ${view}
    ${newest.job_id && html`<p>${t("recipe.of_job")} <a href=${`/jobs/${encodeURIComponent(newest.job_id)}`}>${newest.job_id}</a></p>`}
    ${newest.problem && html`<p role="alert" class="problem">${newest.problem}</p>`}
    ${newest.result && html`<${Facts} editor=${editor} result=${newest.result}/>`}`;
}
