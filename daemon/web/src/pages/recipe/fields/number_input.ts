// The input of one number of the document.
import { useState } from "preact/hooks";
import { html } from "../../../lib/html.ts";
import { type Path, getAt } from "../../../recipe/document.ts";
import type { Editor } from "../editor.ts";
import { shownText, valueOfText } from "./typed_number.ts";

export function NumberInput({ editor, path, about, narrow }: { editor: Editor; path: Path; about: Record<string, unknown>; narrow?: boolean }) {
  const [typed, setTyped] = useState("");
  const input = (event: Event): void => {
    const text = (event.target as HTMLInputElement).value;
    setTyped(text);
    const next = valueOfText(text);
    if (next === undefined) editor.remove(path);
    else editor.set(path, next);
  };
  return html`<input class=${narrow ? "number limit" : "number"} inputmode="decimal" autocomplete="off" ...${about}
    value=${shownText(typed, getAt(editor.document ?? undefined, path))} onInput=${input}/>`;
}
