// The map that one can hold: pan, zoom, the profile's ends, a cursor of the pointer and one of the keyboard.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { Shape } from "../../result/fitted_geometry.ts";
import type { Range } from "../../surface/colours.ts";
import type { Point } from "../../surface/full_map.ts";
import type { Tile } from "../../surface/height_tile.ts";
import { type View, clampView, fitView, middleOf, onCanvas, pointAt, toMap, toScreen, zoomAt } from "../../surface/map_view.ts";
import type { Place, ProfileLine } from "../../surface/profile_line.ts";
import { MapCanvas, type Plane } from "./map_canvas.ts";
import { MapOverlay } from "./map_overlay.ts";
import type { ResultMap } from "./use_map.ts";
import { useWidth } from "./use_size.ts";

interface Props {
  map: ResultMap;
  overview: Tile;
  range: Range;
  plane: Plane;
  summary: string;
  shapes: Shape[];
  line: ProfileLine;
  marks: Place[];
  cursor: Point | null;
  onCursor: (cursor: Point | null, byKeyboard: boolean) => void;
  onLine: (line: ProfileLine) => void;
  onFactor: (factor: number) => void;
  onError: (error: unknown) => void;
}

const kGrip = 22;  // CSS pixels around a profile's end that hold it: a target of 44
const kZoomStep = 1.25;

type Held = { what: "from" | "to" } | { what: "map"; x: number; y: number; view: View };

export function MapStage(props: Props) {
  const { map, overview, line, cursor, onCursor, onLine } = props;
  const holder = useRef<HTMLDivElement>(null);
  const held = useRef<Held | null>(null);
  const [kept, setView] = useState<View | null>(null);
  const width = useWidth(holder);
  const { size } = map;
  const aspect = (size.height * size.pitch_y) / (size.width * size.pitch_x);
  const canvas = { width, height: Math.max(220, Math.min(Math.round(width * aspect), Math.round(innerHeight * 0.72), 1400)) };
  const view = clampView(kept ?? fitView(size, canvas), size, canvas);
  const placeIn = (stage: HTMLElement, { clientX, clientY }: MouseEvent): Place =>
    onCanvas(canvas, (stage.querySelector(".map-canvas") ?? stage).getBoundingClientRect(), { x: clientX, y: clientY });

  // A wheel over the page scrolls it; over the map that was chosen, or with Ctrl, it zooms, from the view as it is drawn.
  useLayoutEffect(() => {
    const element = holder.current;
    if (!element) return;
    const turn = (event: WheelEvent): void => {
      if (!event.ctrlKey && document.activeElement !== element) return;
      event.preventDefault();
      const at = placeIn(element, event);
      setView(zoomAt(view, canvas, at, Math.exp(-Math.max(-100, Math.min(100, event.deltaY)) * 0.0025), size));
    };
    element.addEventListener("wheel", turn, { passive: false });
    return () => element.removeEventListener("wheel", turn);
  });

  // Of the same elements as below: the one that is measured must be the one that stays.
  if (width === 0) return html`<div><div ref=${holder} class="map-stage"></div></div>`;

  const place = (event: PointerEvent): Place => placeIn(event.currentTarget as HTMLElement, event);
  const inside = (at: Place): Place => ({
    x: Math.max(0, Math.min(size.width * size.pitch_x, at.x)),
    y: Math.max(0, Math.min(size.height * size.pitch_y, at.y)),
  });
  const down = (event: PointerEvent): void => {
    if (event.button !== 0) return;
    const at = place(event);
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    const near = (["to", "from"] as const).find((end) => {
      const there = toScreen(view, canvas, line[end]);
      return Math.hypot(there.x - at.x, there.y - at.y) <= kGrip;
    });
    held.current = near ? { what: near } : { what: "map", ...at, view };
  };
  const move = (event: PointerEvent): void => {
    const at = place(event);
    const hold = held.current;
    let seen = view;
    if (hold?.what === "map") {
      seen = clampView({ ...hold.view, x: hold.view.x - (at.x - hold.x) / view.scale, y: hold.view.y - (at.y - hold.y) / view.scale }, size, canvas);
      setView(seen);
    } else if (hold) {
      onLine({ ...line, [hold.what]: inside(toMap(view, canvas, at)) });
    }
    onCursor(pointAt(size, toMap(seen, canvas, at)), false);
  };
  const zoom = (by: number): void => {
    const middle = cursor ? toScreen(view, canvas, middleOf(size, cursor)) : { x: canvas.width / 2, y: canvas.height / 2 };
    setView(zoomAt(view, canvas, middle, by, size));
  };
  const step = (dx: number, dy: number): void => {
    const from = cursor ?? pointAt(size, { x: view.x, y: view.y }) ?? { column: 0, row: 0 };
    const next = {
      column: Math.max(0, Math.min(size.width - 1, from.column + (cursor ? dx : 0))),
      row: Math.max(0, Math.min(size.height - 1, from.row + (cursor ? dy : 0))),
    };
    onCursor(next, true);
    const at = toScreen(view, canvas, middleOf(size, next));
    if (at.x < 8 || at.y < 8 || at.x > canvas.width - 8 || at.y > canvas.height - 8) setView(clampView({ ...view, ...middleOf(size, next) }, size, canvas));
  };
  const key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const far = event.shiftKey ? 10 : 1;
    const acts: Record<string, () => void> = {
      ArrowLeft: () => step(-far, 0), ArrowRight: () => step(far, 0), ArrowUp: () => step(0, -far), ArrowDown: () => step(0, far),
      "+": () => zoom(kZoomStep), "=": () => zoom(kZoomStep), "-": () => zoom(1 / kZoomStep), "0": () => setView(null),
      a: () => cursor && onLine({ ...line, from: middleOf(size, cursor) }),
      b: () => cursor && onLine({ ...line, to: middleOf(size, cursor) }),
    };
    const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  };

  return html`<div>
    <div ref=${holder} class="map-stage" tabindex="0" role="application" aria-label=${t("result.map.label")} aria-describedby="map-summary map-keys"
      onPointerDown=${down} onPointerMove=${move} onPointerUp=${() => void (held.current = null)} onPointerCancel=${() => void (held.current = null)}
      onPointerLeave=${() => held.current ?? onCursor(null, false)} onKeyDown=${key}>
      <${MapCanvas} job=${map.full.job} kind=${overview.kind} map=${size} overview=${overview} range=${props.range} plane=${props.plane}
        view=${view} canvas=${canvas} onFactor=${props.onFactor} onError=${props.onError}/>
      <${MapOverlay} map=${size} unit=${map.unit} view=${view} canvas=${canvas} shapes=${props.shapes} line=${line} cursor=${cursor} marks=${props.marks}/>
      <span class="hidden" role="img" aria-label=${props.summary}></span>
    </div>
    <p class="buttons">
      <button type="button" onClick=${() => zoom(kZoomStep ** 2)}>${t("result.zoom_in")}</button>
      <button type="button" onClick=${() => zoom(kZoomStep ** -2)}>${t("result.zoom_out")}</button>
      <button type="button" onClick=${() => setView(null)}>${t("result.fit")}</button>
    </p>
    <p id="map-keys" class="help">${t("result.map.keys")}</p>
  </div>`;
}
