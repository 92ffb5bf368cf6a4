// Tries the draft, on the newest result or with a scan, and shows what the values become.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";
import { tryId } from "../../recipe/ids.ts";
import { hasMeasurements } from "../../recipe/kinds.ts";
import { evaluateBy, keepForTrial, pressed, scanBy } from "../../recipe/try_recipe.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { type Value, valuesOf } from "../../results/values.ts";
import type { Editor } from "./editor.ts";
import { JobChoice } from "./job_choice.ts";
import type { Newest } from "./newest_job.ts";
import { ValuePairs } from "./value_pairs.ts";

interface Trial {
  id: string;
  job_id: string;  // whose values are the old ones
  text: string;  // of the draft that was tried
  before: Value[];
  values: Value[];
  verdict: string | null;
}

export function TryPanel({ editor, newest }: { editor: Editor; newest: Newest }) {
  const { who, role } = useStore(session);
  const { state } = useStore(topics);
  const [trial, setTrial] = useState<Trial | null>(null);
  const [busy, setBusy] = useState("");
  const [problem, setProblem] = useState("");
  const why = !mayAs(role, "set_up") ? t("recipe.needs_set_up")
    : !editor.isChecked ? t("recipe.checking")
    : !editor.check?.accepted ? t("recipe.save_refused") : "";
  const whyNotEvaluate = why || (newest.result === null ? t("recipe.no_job")
    : editor.document !== null && !hasMeasurements(editor.document) ? t("recipe.measurement_first") : "");
  const whyNotScan = why || (state !== null && !state.ready ? t("recipe.not_ready", { state: state.state ?? "" }) : "");

  // What the draft's values are set beside: the result's own where it was measured by this recipe, else what the saved recipe makes of it.
  const old = async (): Promise<Value[]> => {
    if (newest.result === null) return [];
    if (newest.recipe === editor.id) return valuesOf(newest.result);
    return evaluateBy(newest.job_id, editor.id).then(({ result }) => valuesOf(result), () => valuesOf(newest.result));
  };
  const run = async (what: (recipe: string, press: ReturnType<typeof pressed>) => Promise<{ id: string; result: unknown }>): Promise<void> => {
    const press = pressed();
    const { text } = editor;
    setBusy(t("recipe.trying"));
    setProblem("");
    try {
      const { id, result } = await what(await keepForTrial(editor.id, text, who), press);
      // After it: what was pressed shall not wait for it.
      const before = trial && trial.job_id === newest.job_id ? trial.before : await old();
      const verdict = (result as { verdict?: unknown } | null)?.verdict;
      setTrial({ id, job_id: newest.job_id, text, before, values: valuesOf(result), verdict: typeof verdict === "string" ? verdict : null });
    } catch (error) {
      setProblem(messageOf(error));
    }
    setBusy("");
  };
  return html`
    <${JobChoice} newest=${newest} recipe=${editor.id}/>
    <p class="help">${t("recipe.try_help", { id: tryId(editor.id) })}</p>
    <p class="buttons">
      <button type="button" class="main" disabled=${busy !== "" || whyNotEvaluate !== ""} aria-describedby="try-why"
        onClick=${() => void run((recipe) => evaluateBy(newest.job_id, recipe))}>${t("recipe.try_evaluate")}</button>
      <button type="button" disabled=${busy !== "" || whyNotScan !== ""} aria-describedby="try-why"
        onClick=${() => void run((recipe, press) => scanBy(recipe, "trial", press, (progress) => setBusy(t("recipe.scanning", { percent: Math.round(100 * progress) }))))}>${t("recipe.try_scan")}</button>
    </p>
    <p id="try-why" class="help">${whyNotEvaluate}${whyNotScan !== whyNotEvaluate ? ` ${whyNotScan}` : ""}</p>
    <p aria-live="polite">${busy}</p>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${trial && html`
      <h3><${VerdictLabel} verdict=${trial.verdict}/> <a href=${`/jobs/${encodeURIComponent(trial.id)}`}>${trial.id}</a></h3>
      ${trial.text !== editor.text && html`<p class="help">${t("recipe.tried_before")}</p>`}
      <${ValuePairs} before=${trial.before} after=${trial.values} heads=${[t("recipe.old"), t("recipe.new_value")]}/>`}`;
}
