// Things that the author names: regions, surfaces, measurements, limits. To add one, to name it anew, to take it away.
import { useState } from "preact/hooks";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { freeName, getAt, pointerOf } from "../../../recipe/document.ts";
import { problemsAt, problemsUnder } from "../../../recipe/problems.ts";
import { type Schema, initialOf, isObject, nameOfShape, shapeOf } from "../../../recipe/schema.ts";
import { Field, type FieldProps } from "./field.ts";
import { idOf } from "./field_frame.ts";
import { helpOf, nameOf } from "./names.ts";
import { Members } from "./object_field.ts";

function Entry({ editor, schema, path, fresh, renamed }: Omit<FieldProps, "required"> & { fresh: boolean; renamed: (name: string) => void }) {
  const name = path[path.length - 1] ?? "";
  const value = getAt(editor.document ?? undefined, path);
  const shape = schema.oneOf?.[shapeOf(schema.oneOf, value)];
  const wrong = problemsUnder(editor.problems, pointerOf(path)).length;
  const id = idOf(path);
  const [typed, setTyped] = useState<string | null>(null);  // a name is one when it is done: half of it may be that of another
  const [open] = useState(fresh);  // from then on it is the reader's to fold
  return html`<details class="entry" open=${open}>
    <summary id=${schema.oneOf ? undefined : id}><strong>${name}</strong> ${shape && html`<span class="help">${nameOf(nameOfShape(shape))}</span>`}
      ${wrong > 0 && html`<span class="problem">⚠ ${t("recipe.problems", { count: wrong })}</span>`}</summary>
    <div class="field">
      <label for=${`${id}-name`}>${t("recipe.name")}</label>
      <input id=${`${id}-name`} value=${typed ?? name} autocomplete="off" onInput=${(event: Event) => setTyped((event.target as HTMLInputElement).value)} onChange=${(event: Event) => {
        const wanted = (event.target as HTMLInputElement).value.trim();
        setTyped(null);
        if (wanted === "" || wanted === name) return;
        renamed(wanted);
        editor.rename(path, wanted);
      }}/>
    </div>
    ${schema.oneOf ? html`<${Field} editor=${editor} schema=${schema} path=${path} required/>` : html`<${Members} editor=${editor} schema=${schema} path=${path}/>`}
    <p class="buttons"><button type="button" onClick=${() => {
      editor.remove(path);
      document.getElementById(idOf(path.slice(0, -1)))?.focus();
    }}>${t("recipe.remove", { name })}</button></p>
  </details>`;
}

export function MapField({ editor, schema, path }: FieldProps) {
  const key = path[path.length - 1] ?? "";
  const inner = schema.additionalProperties as Schema;
  const value = getAt(editor.document ?? undefined, path);
  const names = isObject(value) ? Object.keys(value) : [];
  const [name, setName] = useState("");
  const [shape, setShape] = useState(0);
  const [fresh, setFresh] = useState("");
  const [open] = useState(names.length > 0);
  const add = (): void => {
    const about = inner.oneOf?.[shape] ?? inner;
    const wanted = name.trim() || (inner.oneOf ? nameOfShape(about).replace(/_(um|png)$/, "") : key.replace(/s$/, ""));
    const free = freeName(value, wanted);
    setFresh(free);
    editor.set([...path, free], initialOf(about));
    setName("");
  };
  const id = idOf(path);
  const wrong = problemsUnder(editor.problems, pointerOf(path)).length;
  return html`<details class="map" open=${open}>
    <summary id=${id}>${nameOf(key)} (${names.length}) ${wrong > 0 && html`<span class="problem">⚠ ${t("recipe.problems", { count: wrong })}</span>`}</summary>
    <p class="help">${helpOf(schema)}</p>
    ${problemsAt(editor.problems, pointerOf(path)).map((problem) => html`<p class="problem">⚠ ${problem.text}</p>`)}
    ${names.map((each) => html`<${Entry} key=${each} editor=${editor} schema=${inner} path=${[...path, each]} fresh=${each === fresh} renamed=${setFresh}/>`)}
    <div class="add">
      ${inner.oneOf && html`<label>${t("recipe.shape")} <select value=${String(shape)} onChange=${(event: Event) => setShape(Number((event.target as HTMLSelectElement).value))}>
        ${inner.oneOf.map((each, i) => html`<option value=${String(i)}>${nameOf(nameOfShape(each))}</option>`)}</select></label>`}
      <label>${t("recipe.name")} <input value=${name} autocomplete="off" onInput=${(event: Event) => setName((event.target as HTMLInputElement).value)}
        onKeyDown=${(event: KeyboardEvent) => { if (event.key === "Enter") { event.preventDefault(); add(); } }}/></label>
      <button type="button" onClick=${add}>${t("recipe.add_to", { what: nameOf(key) })}</button>
    </div>
  </details>`;
}
