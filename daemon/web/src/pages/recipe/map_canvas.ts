// The picture of a map with shapes on it that the pointer drags.
import { useEffect, useRef } from "preact/hooks";
import { html } from "../../lib/html.ts";
import { type Drawn, type Edit, type Point, contains, dragged, handleAt, moved, spanned } from "../../recipe/drawing.ts";
import { percentileRange } from "../../surface/colour_range.ts";
import { kViridisTable } from "../../surface/colours.ts";
import type { Tile } from "../../surface/height_tile.ts";
import { pictureOf } from "../../surface/paint.ts";

const kReach_px = 22;  // of a finger
const kWidth_px = 800;
const kDraws_px = 8;  // a press moves less by itself

interface Props {
  heights: Tile;
  size: Point;  // of the map in um
  shapes: readonly Drawn[];
  selected: string;
  label: string;
  keyOf: (shape: Drawn) => string;
  onSelect: (key: string) => void;
  onEdit: (edits: readonly Edit[]) => void;
  onDraw: (from: Point, to: Point) => string;  // a new rectangle; its key
}

function outline(context: CanvasRenderingContext2D, shape: Drawn, at: (point: Point) => Point, scale: number): void {
  const [a = { x: 0, y: 0 }, b = { x: 0, y: 0 }] = shape.handles.map(at);
  context.beginPath();
  if (shape.kind === "rectangle") context.rect(a.x, a.y, b.x - a.x, b.y - a.y);
  else if (shape.kind === "circle") context.arc(a.x, a.y, Math.hypot(b.x - a.x, b.y - a.y), 0, 2 * Math.PI);
  else {
    shape.handles.map(at).forEach((point) => context.lineTo(point.x, point.y));
    if (shape.kind === "polygon") context.closePath();
  }
  if (shape.kind === "line" && shape.width_um > 0) {
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const [nx, ny] = [(-(b.y - a.y) / length) * shape.width_um * scale / 2, ((b.x - a.x) / length) * shape.width_um * scale / 2];
    context.moveTo(a.x + nx, a.y + ny);
    context.lineTo(b.x + nx, b.y + ny);
    context.moveTo(a.x - nx, a.y - ny);
    context.lineTo(b.x - nx, b.y - ny);
  }
}

export function MapCanvas({ heights, size, shapes, selected, label, keyOf, onSelect, onEdit, onDraw }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const picture = useRef<HTMLCanvasElement | null>(null);
  const drag = useRef<{ key: string; handle: number; last: Point; from: Point | null } | null>(null);
  const height_px = Math.max(1, Math.round((kWidth_px * size.y) / size.x));
  const scale = kWidth_px / size.x;  // px per um

  useEffect(() => {
    const own = document.createElement("canvas");
    own.width = heights.width;
    own.height = heights.height;
    own.getContext("2d")?.putImageData(pictureOf(heights.mean, heights.width, heights.height, percentileRange(heights.mean, 0.005, 0.995) ?? { low: 0, high: 1 }, kViridisTable), 0, 0);
    picture.current = own;
  }, [heights]);
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context || !picture.current) return;
    context.clearRect(0, 0, kWidth_px, height_px);
    context.imageSmoothingEnabled = false;
    // The last block may reach beyond the map's border.
    const [w, h] = [(heights.width * heights.factor * kWidth_px) / heights.map_width, (heights.height * heights.factor * height_px) / heights.map_height];
    context.drawImage(picture.current, 0, 0, w, h);
    const at = (point: Point): Point => ({ x: point.x * scale, y: point.y * scale });
    for (const shape of shapes) {
      const on = keyOf(shape) === selected;
      // Dark below light: seen on every colour of the map.
      for (const [style, width] of [["#000", on ? 7 : 5], ["#fff", on ? 4 : 2]] as const) {
        context.strokeStyle = style;
        context.lineWidth = width;
        outline(context, shape, at, scale);
        context.stroke();
        if (on) for (const point of shape.handles.map(at)) {
          context.beginPath();
          context.arc(point.x, point.y, 9, 0, 2 * Math.PI);
          context.stroke();
        }
      }
      const named = at(shape.handles[0] ?? { x: 0, y: 0 });
      context.font = "600 20px system-ui, sans-serif";
      context.lineWidth = 4;
      context.strokeStyle = "#000";
      context.fillStyle = "#fff";
      context.strokeText(shape.name, named.x + 8, named.y + 24);
      context.fillText(shape.name, named.x + 8, named.y + 24);
    }
  }, [heights, shapes, selected, scale]);

  const pointAt = (event: PointerEvent): Point => {
    const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
    return { x: ((event.clientX - box.left) / box.width) * size.x, y: ((event.clientY - box.top) / box.height) * size.y };
  };
  const down = (event: PointerEvent): void => {
    const at = pointAt(event);
    const reach = (kReach_px / (event.currentTarget as HTMLElement).getBoundingClientRect().width) * size.x;
    // The selected one first: its handles may lie in another shape.
    const order = [...shapes].sort((a, b) => Number(keyOf(b) === selected) - Number(keyOf(a) === selected));
    const hit = order.find((shape) => handleAt(shape, at, reach) >= 0) ?? order.find((shape) => contains(shape, at, reach));
    onSelect(hit ? keyOf(hit) : "");
    const handle = hit ? handleAt(hit, at, reach) : -1;
    // Of a rectangle the other corner stays where it is.
    const from = !hit ? at : hit.kind === "rectangle" && handle >= 0 ? hit.handles[1 - handle] ?? null : null;
    drag.current = { key: hit ? keyOf(hit) : "", handle, last: at, from };
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
  };
  const move = (event: PointerEvent): void => {
    const doing = drag.current;
    if (!doing) return;
    const at = pointAt(event);
    if (doing.key === "" && doing.from) {
      const um_per_px = size.x / (event.currentTarget as HTMLElement).getBoundingClientRect().width;
      if (Math.hypot(at.x - doing.from.x, at.y - doing.from.y) > kDraws_px * um_per_px) doing.key = onDraw(doing.from, at);
      return;
    }
    const shape = shapes.find((each) => keyOf(each) === doing.key);
    if (!shape) return;
    const inside = { x: Math.min(size.x, Math.max(0, at.x)), y: Math.min(size.y, Math.max(0, at.y)) };
    onEdit(doing.from ? spanned(shape, doing.from, inside) : doing.handle >= 0 ? dragged(shape, doing.handle, at) : moved(shape, at.x - doing.last.x, at.y - doing.last.y));
    doing.last = at;
  };
  const up = (): void => { drag.current = null; };
  return html`<canvas class="region-map" ref=${canvas} width=${kWidth_px} height=${height_px} role="img" aria-label=${label}
    onPointerDown=${down} onPointerMove=${move} onPointerUp=${up} onPointerCancel=${up}></canvas>`;
}
