// What the daemon's checker says of the document as it stands, problem by problem.
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { ancestors } from "../../recipe/problems.ts";
import { pathOf } from "../../recipe/document.ts";
import type { Editor } from "./editor.ts";
import { idOf } from "./fields/field_frame.ts";

// Goes to the field of a pointer, or of what it lies in; unfolds what hides it.
export function goToField(pointer: string): boolean {
  for (const each of ancestors(pointer)) {
    const field = document.getElementById(idOf(pathOf(each)));
    if (!field) continue;
    for (let above = field.parentElement; above; above = above.parentElement) if (above instanceof HTMLDetailsElement) above.open = true;
    field.focus();
    field.scrollIntoView({ block: "center" });
    return true;
  }
  return false;
}

export function CheckState({ editor, onShow }: { editor: Editor; onShow: (pointer: string) => void }) {
  const { check } = editor;
  if (check === null) return html`<p class="check" aria-live="polite">${t("recipe.checking")}</p>`;
  const state = check.failed !== "" ? "failed" : check.accepted ? "good" : "bad";
  const count = check.problems.length;
  return html`<div class="check panel ${state}" data-state=${editor.isChecked ? state : "checking"}>
    <p aria-live="polite"><strong>
      ${state === "good" && `● ${t("recipe.accepted")}`}
      ${state === "bad" && `■ ${t(count === 1 ? "recipe.refused_one" : "recipe.refused", { count })}`}
      ${state === "failed" && `▲ ${t("recipe.not_checked")} ${check.failed}`}
    </strong>${!editor.isChecked && html` <span class="help">${t("recipe.checking")}</span>`}</p>
    ${count > 0 && html`<ul class="problems">${check.problems.map((problem) => html`<li>
      ${problem.pointer !== null
        ? html`<button type="button" class="place" onClick=${() => { if (!goToField(problem.pointer ?? "")) onShow(problem.pointer ?? ""); }}><code>${problem.pointer}</code></button>`
        : problem.line !== undefined && html`<button type="button" class="place" onClick=${() => onShow(`line:${problem.line}:${problem.column}`)}>${t("recipe.line", { line: problem.line, column: problem.column ?? 1 })}</button>`}
      <span lang="en">${problem.text}</span></li>`)}</ul>`}
    ${check.notes.length > 0 && html`<h3>${t("recipe.notes")}</h3><ul>${check.notes.map((note) => html`<li lang="en">${note}</li>`)}</ul>`}
  </div>`;
}
