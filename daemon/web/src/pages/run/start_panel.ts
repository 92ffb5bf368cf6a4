// Which part, by which recipe, and the one button.
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, resyncs, topics } from "../../live/live.ts";
import { isTryId } from "../../recipe/ids.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { kMostPartId, nextPartId, partIdProblem } from "../../run/part_ids.ts";
import { offered } from "../../run/recipe_choice.ts";
import { kClient } from "../../run/start_job.ts";
import { askNewest, home } from "./commands.ts";
import { OneButton } from "./one_button.ts";
import { countsOn, lacksReference, notice, partId, recipeChoice, recipes, setCountsOn } from "./run_state.ts";
import { focusIfFree, useKeys } from "./use_keys.ts";
import { useRecipeId } from "./use_machine.ts";
import { useRecipeList } from "./use_recipe_list.ts";

function RecipeChoice() {
  const known = useStore(recipes);
  const id = useRecipeId();
  const problem = useRecipeList();
  return html`<label class="field">${t("run.recipe")}
      <select value=${id} onChange=${(event: Event) => recipeChoice.set((event.target as HTMLSelectElement).value)}>
        ${id === "" && html`<option value="" disabled></option>`}
        ${offered(known ?? (id === "" ? [] : [id])).map((each) => html`<option key=${each} value=${each}>${each}${isTryId(each) && ` – ${t("recipe.kind_try")}`}</option>`)}
      </select>
    </label>
    ${known?.length === 0 && html`<p class="help">${t("run.no_recipes")}</p>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}`;
}

function PartField() {
  const id = useStore(partId);
  const on = useStore(countsOn);
  const { job } = useStore(topics);
  const input = useRef<HTMLInputElement>(null);
  const [said, setSaid] = useState("");
  const taken = useCallback((code: string): void => {
    setSaid(t("run.part_taken", { part: code }));
    notice.set(null);
  }, []);
  useKeys(taken);
  // As the page opens, and once somebody has logged in: the dialog that had the focus is gone. Who only looks names no part.
  const { who, role } = useStore(session);
  const names = mayAs(role, "operate");
  useEffect(() => {
    if (names) focusIfFree(input.current);
  }, [who, names]);
  const problem = id === "" ? "none" : partIdProblem(id);
  const submit = (event: Event): void => {
    // A scanner ends with Enter: the id is taken, and nothing moves before the button is pressed.
    event.preventDefault();
    input.current?.select();
    if (id !== "") taken(id);
  };
  return html`<form onSubmit=${submit} novalidate>
    <label class="field">${t("run.part")}
      <input ref=${input} type="text" value=${id} autocomplete="off" spellcheck=${false} dir="auto" enterkeyhint="done"
        aria-invalid=${problem !== "none"} aria-describedby="part-problem"
        onInput=${(event: Event) => partId.set((event.target as HTMLInputElement).value)}/>
    </label>
    <p id="part-problem" class="problem">${problem !== "none" && tWord("run.why", `part_${problem}`)}${" "}
      ${problem === "long" && t("run.part_count", { count: id.length, most: kMostPartId })}</p>
    <p class="hidden" role="status">${said}</p>
    <div class="buttons">
      <button type="button" onClick=${() => partId.set(nextPartId(id || job?.part_id || ""))}>${t("run.next_number")}</button>
      <label class="check"><input type="checkbox" checked=${on} onChange=${(event: Event) => setCountsOn((event.target as HTMLInputElement).checked)}/> ${t("run.counts_on")}</label>
    </div>
  </form>`;
}

function Told() {
  const told = useStore(notice);
  return html`<div class="told">
    <div role="alert">${told?.kind === "problem" && html`<p class="problem">${told.text}</p>`}</div>
    <div role="status">${told?.kind === "note" && html`<p>${told.text}</p>`}</div>
  </div>`;
}

const kHomeHelps = [1113, 1115];

export function StartPanel() {
  useLanguage();
  const { state, job } = useStore(topics);
  const { role } = useStore(session);
  const lacks = useStore(lacksReference);
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  const ours = job?.client === kClient ? job.seq : 0;
  useEffect(() => {
    if (isLinked) askNewest();
  }, [count, isLinked, ours]);
  return html`<section class="panel start" aria-labelledby="start-title">
    <h2 id="start-title">${t("run.start_title")}</h2>
    <${PartField}/>
    <${RecipeChoice}/>
    <${OneButton}/>
    <${Told}/>
    ${((state?.state === "error" && kHomeHelps.includes(state.error_code)) || lacks) && mayAs(role, "operate") &&
      html`<p class="buttons"><button type="button" onClick=${() => void home()}>${t("run.home")}</button></p>`}
  </section>`;
}
