// One shape of the map in the list beside it: chosen and moved by keys, named, taken away.
import { useState } from "preact/hooks";
import { number, t, type TextKey } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { Drawn } from "../../recipe/drawing.ts";

export function ShapeEntry({ shape, selected, onSelect, onKey, onRename, onRemove }: {
  shape: Drawn;
  selected: boolean;
  onSelect: () => void;
  onKey: (event: KeyboardEvent) => void;
  onRename: (name: string) => void;
  onRemove: () => void;
}) {
  const [typed, setTyped] = useState<string | null>(null);
  const rename = (event: Event): void => {
    const name = (event.target as HTMLInputElement).value.trim();
    setTyped(null);
    if (name !== "" && name !== shape.name) onRename(name);
  };
  return html`<li>
    <button type="button" aria-pressed=${selected ? "true" : "false"} aria-describedby="shape-help" onClick=${onSelect} onKeyDown=${onKey}>
      ${shape.name} (${t(`recipe.shape_${shape.kind}` as TextKey)})</button>
    <label class="shape-name">${t("recipe.name")} <input value=${typed ?? shape.name} autocomplete="off" dir="auto"
      onInput=${(event: Event) => setTyped((event.target as HTMLInputElement).value)} onChange=${rename}/></label>
    <button type="button" onClick=${onRemove}>${t("recipe.remove", { name: shape.name })}</button>
    <span class="help">${shape.handles.slice(0, 4).map((point) => `${number(point.x)}; ${number(point.y)}`).join(" → ")} µm</span>
  </li>`;
}
