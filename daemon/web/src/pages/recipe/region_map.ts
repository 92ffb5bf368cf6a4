// The recipe's regions and profiles on the newest map: seen, dragged, moved by keys, added.
import { useState } from "preact/hooks";
import { number, t, type TextKey } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { freeName, getAt } from "../../recipe/document.ts";
import { type Drawn, type Edit, type Point, drawingsOf, dragged, moved, newShape, rectangleBetween } from "../../recipe/drawing.ts";
import type { Editor } from "./editor.ts";
import { JobChoice } from "./job_choice.ts";
import { MapCanvas } from "./map_canvas.ts";
import { type Newest, pitchOf } from "./newest_job.ts";
import { ShapeEntry } from "./shape_entry.ts";
import { useHeights } from "./use_heights.ts";

const kArrows: Record<string, readonly [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export function RegionMap({ editor, newest }: { editor: Editor; newest: Newest }) {
  const { heights, problem } = useHeights(newest);
  const [selected, setSelected] = useState("");

  const shapes = editor.document === null ? [] : drawingsOf(editor.document);
  const pitch = pitchOf(newest.result) ?? { x: 1, y: 1 };
  const size = heights && { x: heights.map_width * pitch.x, y: heights.map_height * pitch.y };
  const apply = (edits: readonly Edit[]): void => edits.forEach(({ path, value }) => editor.set(path, value));
  const keyOf = (shape: Drawn): string => shape.path.join("/");

  const add = (kind: Drawn["kind"], value = newShape(kind, size?.x ?? 100, size?.y ?? 100)): string => {
    const section = kind === "line" ? "measurements" : "regions";
    const name = freeName(getAt(editor.document ?? undefined, ["evaluation", section]), kind === "line" ? "profile" : "region");
    const path = ["evaluation", section, name];
    editor.set(path, value);
    const added = (kind === "line" ? path : [...path, `${kind}_um`]).join("/");
    setSelected(added);
    return added;
  };
  const draw = (from: Point, to: Point): string => add("rectangle", { rectangle_um: rectangleBetween(from, to, size ?? to) });
  const key = (event: KeyboardEvent, shape: Drawn): void => {
    const way = kArrows[event.key];
    if (!way) return;
    event.preventDefault();
    const by = event.shiftKey ? 10 : 1;  // pixels of the map
    const [dx, dy] = [way[0] * pitch.x * by, way[1] * pitch.y * by];
    const last = shape.handles.length - 1;
    const end = shape.handles[last] ?? { x: 0, y: 0 };
    apply(event.altKey ? dragged(shape, last, { x: end.x + dx, y: end.y + dy }) : moved(shape, dx, dy));
  };
  return html`
    <${JobChoice} newest=${newest} recipe=${editor.id}/>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${heights && size && html`<${MapCanvas} heights=${heights} size=${size} shapes=${shapes} selected=${selected}
      label=${t("recipe.map_label", { width: number(size.x, 0), height: number(size.y, 0), count: shapes.length })}
      keyOf=${keyOf} onSelect=${setSelected} onEdit=${apply} onDraw=${draw}/>`}
    <p class="buttons">${(["rectangle", "circle", "polygon", "line"] as const).map((kind) => html`
      <button type="button" disabled=${editor.document === null} onClick=${() => add(kind)}>${t(`recipe.add_${kind}` as TextKey)}</button>`)}</p>
    <p class="help" id="shape-help">${t("recipe.shape_keys")}</p>
    <ul class="shapes">${shapes.map((shape) => html`<${ShapeEntry} key=${keyOf(shape)} shape=${shape} selected=${selected === keyOf(shape)}
      onSelect=${() => setSelected(keyOf(shape))} onKey=${(event: KeyboardEvent) => key(event, shape)}
      onRename=${(name: string) => editor.rename(shape.path.slice(0, 3), name)} onRemove=${() => editor.remove(shape.path.slice(0, 3))}/>`)}</ul>`;
}
