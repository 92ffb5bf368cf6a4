// The line as a measurement of the recipe: into the draft of this tab, which the recipe page shows and saves.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import { call } from "../../rpc/rpc.ts";
import { keepDraft, readDraft } from "../../recipe/draft.ts";
import { freeName, measurementNames, profileMeasurement, withMeasurement } from "../../result/recipe_draft.ts";
import type { ProfileLine } from "../../surface/profile_line.ts";

const kParameters = ["Pt", "Pa", "Pq", "Wt", "Ra", "Rq", "Rz"] as const;

async function keep(recipe: string, line: ProfileLine, wish: string, parameters: readonly string[]): Promise<string> {
  let draft = readDraft(recipe);
  if (!draft) {
    const { text, version } = await call("recipe.get", { id: recipe });
    draft = { text: text ?? "", base_version: version ?? 0 };
  }
  const name = freeName(measurementNames(draft.text), wish);
  keepDraft(recipe, { ...draft, text: withMeasurement(draft.text, name, profileMeasurement(line, parameters)) });
  return name;
}

export function KeepProfile({ recipe, line, isPossible }: { recipe: string; line: ProfileLine; isPossible: boolean }) {
  const [name, setName] = useState("profile");
  const [parameters, setParameters] = useState<readonly string[]>(["Pt"]);
  const [kept, setKept] = useState("");
  const [problem, setProblem] = useState("");
  const reason = !isPossible ? t("result.keep.no_pitch") : parameters.length === 0 ? t("result.keep.none") : "";
  const submit = async (event: SubmitEvent): Promise<void> => {
    event.preventDefault();
    setKept("");
    setProblem("");
    try {
      setKept(await keep(recipe, line, name.trim() || "profile", parameters));
    } catch (error) {
      setProblem(error instanceof SyntaxError ? t("result.keep.no_json") : messageOf(error));
    }
  };
  return html`<details class="keep-profile">
    <summary>${t("result.keep.title")}</summary>
    <form onSubmit=${submit}>
      <label>${t("result.keep.name")} <input value=${name} maxlength="64" pattern="[A-Za-z0-9_.\\-]+" onInput=${(event: Event) => setName((event.target as HTMLInputElement).value)}/></label>
      <fieldset><legend>${t("result.keep.parameters")}</legend>
        ${kParameters.map((each) => html`<label class="choice"><input type="checkbox" checked=${parameters.includes(each)}
          onChange=${() => setParameters(parameters.includes(each) ? parameters.filter((other) => other !== each) : [...parameters, each])}/> ${each}</label>`)}
      </fieldset>
      <p class="buttons"><button type="submit" disabled=${reason !== ""} aria-describedby=${reason ? "keep-reason" : undefined}>${t("result.keep.button")}</button></p>
      ${reason && html`<p id="keep-reason" class="help">${reason}</p>`}
      ${kept && html`<p role="status">${t("result.keep.done", { name: kept })} <a href=${`/recipes/${encodeURIComponent(recipe)}`}>${t("result.keep.open", { recipe })}</a></p>`}
      ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    </form>
  </details>`;
}
