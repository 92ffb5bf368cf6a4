// The stored surface evaluated by another recipe: a record of its own, no new scan.
import { useEffect, useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { go } from "../../lib/router.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { type ResultJson, mapOwner } from "../../result/result_json.ts";

export function EvaluateAgain({ result }: { result: ResultJson }) {
  const { role } = useStore(session);
  const [recipes, setRecipes] = useState<string[]>([]);
  const [recipe, setRecipe] = useState(result.job.recipe);
  const [isBusy, setBusy] = useState(false);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    let gone = false;
    call("recipe.list", {}).then(
      (list) => {
        if (!gone) setRecipes((list.recipes ?? []) as string[]);
      },
      (error: unknown) => {
        if (!gone) setProblem(messageOf(error));
      });
    return () => void (gone = true);
  }, []);
  const reason = mayAs(role, "set_up") ? "" : t("result.again.role");
  const submit = async (event: SubmitEvent): Promise<void> => {
    event.preventDefault();
    setBusy(true);
    setProblem("");
    try {
      const { id } = await call("result.evaluate", { job_id: mapOwner(result), recipe });
      go(`/jobs/${encodeURIComponent(id)}`);
    } catch (error) {
      setProblem(messageOf(error));
      setBusy(false);
    }
  };
  return html`<section class="panel again-panel" aria-labelledby="again-title">
    <h2 id="again-title">${t("result.again.title")}</h2>
    <form onSubmit=${submit}>
      <p class="help">${t("result.again.help")}</p>
      <label>${t("result.again.recipe")}
        <select value=${recipe} onChange=${(event: Event) => setRecipe((event.target as HTMLSelectElement).value)}>
          ${(recipes.includes(recipe) ? recipes : [recipe, ...recipes]).map((id) => html`<option value=${id}>${id}</option>`)}
        </select></label>
      <p class="buttons"><button type="submit" class="main" disabled=${reason !== "" || isBusy} aria-describedby=${reason ? "again-reason" : undefined}>${t("result.again.button")}</button></p>
      ${reason && html`<p id="again-reason" class="help">${reason}</p>`}
      ${isBusy && html`<p role="status">${t("result.again.busy")}</p>`}
      ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    </form>
  </section>`;
}
