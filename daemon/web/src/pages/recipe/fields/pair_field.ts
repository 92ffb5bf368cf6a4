// Two numbers: a point, or from and to.
import { useState } from "preact/hooks";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { tWord } from "../../../i18n/i18n.ts";
import type { FieldProps } from "./field.ts";
import { FieldFrame, idOf } from "./field_frame.ts";
import { pairWith, shownText } from "./typed_number.ts";

export function PairField({ editor, schema, path, required }: FieldProps) {
  const value = getAt(editor.document ?? undefined, path);
  const pair = Array.isArray(value) ? value : [];
  const [typed, setTyped] = useState<readonly [string, string]>(["", ""]);
  const key = path[path.length - 1] ?? "";
  const isPoint = /^\d+$/.test(key) || ((key === "from_um" || key === "to_um") && schema.minItems === 2);
  const input = (i: 0 | 1, text: string): void => {
    setTyped(i === 0 ? [text, typed[1]] : [typed[0], text]);
    // One of two alone is no pair; the checker says so.
    const given = pairWith(pair, i, text);
    if (given.length === 0 && !required) editor.remove(path);
    else editor.set(path, given);
  };
  const shown = (i: 0 | 1): string => shownText(typed[i], pair[i]);
  const words = isPoint ? ["x", "y"] : ["from", "to"];
  return html`<${FieldFrame} editor=${editor} schema=${schema} path=${path} required=${required} group>
    <div class="pair">
      ${([0, 1] as const).map((i) => html`<label>${tWord("recipe.pair", words[i] ?? "")}
        <input class="number" inputmode="decimal" autocomplete="off" aria-describedby=${`${idOf(path)}-help`} value=${shown(i)} disabled=${i === 1 && pair.length === 0}
          onInput=${(event: Event) => input(i, (event.target as HTMLInputElement).value)}/></label>`)}
    </div>
  <//>`;
}
