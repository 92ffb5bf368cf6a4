// The 3D view with what turns it: pointer, keys, buttons.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { number, t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import { percentileRange } from "../../surface/colour_range.ts";
import { type Kind, fetchTile } from "../../surface/height_tile.ts";
import { extent } from "../../surface/map_view.ts";
import { type Look, boundedLook, kFirstLook, restAfter_ms, suggestedExaggeration } from "../../surface/view_angles.ts";
import { NumberField } from "./number_field.ts";
import type { ResultMap } from "./use_map.ts";
import { useWidth } from "./use_size.ts";
import { type Layer, View3dCanvas } from "./view3d_canvas.ts";

const kCoarse = 128;
const kFine = 512;

async function load(job: string, byTexture: boolean, signal: AbortSignal): Promise<{ coarse: Layer; fine: Layer }> {
  const layer = async (most: number): Promise<Layer> => {
    const tile = (kind: Kind) => fetchTile(job, kind, null, most, signal);
    const heights = tile("height");
    const [a, b] = await Promise.all([heights, byTexture ? tile("texture") : heights]);
    return { heights: a, colours: b };
  };
  const [coarse, fine] = await Promise.all([layer(kCoarse), layer(kFine)]);
  return { coarse, fine };
}

export function View3dPanel({ map, summary }: { map: ResultMap; summary: string }) {
  const holder = useRef<HTMLDivElement>(null);
  const width = useWidth(holder);
  const [byTexture, setByTexture] = useState(false);
  const [layers, setLayers] = useState<{ coarse: Layer; fine: Layer; byTexture: boolean } | null>(null);
  const [problem, setProblem] = useState("");
  const [look, setLook] = useState<Look>(kFirstLook);
  const [typed, setTyped] = useState<number | null>(null);
  const [moving, setMoving] = useState(false);
  const [mode, setMode] = useState<"gl" | "relief">("gl");
  const held = useRef<{ x: number; y: number; look: Look } | null>(null);
  const rest = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const turned_ms = useRef(-Infinity);

  useEffect(() => {
    const abort = new AbortController();
    load(map.full.job, byTexture, abort.signal).then(
      (found) => {
        setLayers({ ...found, byTexture });
        setProblem("");
      },
      (error: unknown) => {
        if (!abort.signal.aborted) setProblem(messageOf(error));
      });
    return () => abort.abort();
  }, [map, byTexture]);
  useEffect(() => () => clearTimeout(rest.current), []);

  const turn = (change: Partial<Look>): void => {
    setLook((before) => boundedLook({ ...before, ...change }));
    setMoving(true);
    clearTimeout(rest.current);
    const now_ms = performance.now();
    rest.current = setTimeout(() => setMoving(false), restAfter_ms(now_ms - turned_ms.current));
    turned_ms.current = now_ms;
  };
  useEffect(() => {
    const element = holder.current;
    if (!element) return;
    const wheel = (event: WheelEvent): void => {
      if (!event.ctrlKey && document.activeElement !== element) return;
      event.preventDefault();
      turn({ zoom: look.zoom * Math.exp(-Math.max(-100, Math.min(100, event.deltaY)) * 0.0025) });
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => element.removeEventListener("wheel", wheel);
  });

  const canvas = { width, height: Math.max(220, Math.min(Math.round(width * 0.7), Math.round(innerHeight * 0.7))) };
  // All heights are sorted for it, which is too much for every step of a turn.
  const found = useMemo(() => layers && percentileRange(layers.fine.heights.mean, 0.005, 0.995), [layers]);
  const heights_um = found && { low: found.low * 1e6, high: found.high * 1e6 };
  const range = layers && (layers.byTexture ? { low: 0, high: 255 } : found);
  const exaggeration = typed ?? (heights_um ? suggestedExaggeration(heights_um.high - heights_um.low, extent(map.size).width) : 1);
  const key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = event.shiftKey ? 15 : 5;
    const acts: Record<string, () => void> = {
      ArrowLeft: () => turn({ turn_deg: look.turn_deg - step }), ArrowRight: () => turn({ turn_deg: look.turn_deg + step }),
      ArrowUp: () => turn({ tilt_deg: look.tilt_deg + step }), ArrowDown: () => turn({ tilt_deg: look.tilt_deg - step }),
      "+": () => turn({ zoom: look.zoom * 1.25 }), "=": () => turn({ zoom: look.zoom * 1.25 }), "-": () => turn({ zoom: look.zoom / 1.25 }),
      "0": () => turn(kFirstLook),
    };
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  };
  const button = (label: string, change: () => Partial<Look>) => html`<button type="button" disabled=${mode === "relief"} onClick=${() => turn(change())}>${label}</button>`;

  return html`<section class="panel view3d-panel" aria-labelledby="view3d-title">
    <h2 id="view3d-title">${t("result.view3d.title")}</h2>
    <div class="controls">
      <label>${t("result.view3d.colour")}
        <select value=${byTexture ? "texture" : "height"} onChange=${(event: Event) => setByTexture((event.target as HTMLSelectElement).value === "texture")}>
          <option value="height">${t("result.kind.height")}</option><option value="texture">${t("result.kind.texture")}</option>
        </select></label>
      <${NumberField} label=${t("result.view3d.exaggeration")} value=${exaggeration} digits=${1} least=${0.1} most=${1000} onChange=${setTyped}/>
    </div>
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    <p id="view3d-summary" class="help">${summary}</p>
    <div ref=${holder} class="view3d-stage" tabindex="0" role="application" aria-label=${t("result.view3d.label")} aria-describedby="view3d-summary view3d-keys"
      style=${{ height: `${canvas.height}px` }} onKeyDown=${key}
      onPointerDown=${(event: PointerEvent) => {
        (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
        held.current = { x: event.clientX, y: event.clientY, look };
      }}
      onPointerMove=${(event: PointerEvent) => {
        const from = held.current;
        if (from) turn({ turn_deg: from.look.turn_deg + (event.clientX - from.x) * 0.4, tilt_deg: from.look.tilt_deg + (event.clientY - from.y) * 0.4 });
      }}
      onPointerUp=${() => void (held.current = null)} onPointerCancel=${() => void (held.current = null)}>
      ${layers && range && heights_um && width > 0 && html`<${View3dCanvas} coarse=${layers.coarse} fine=${layers.fine} map=${map.size} range=${range} heights_um=${heights_um}
        byTexture=${layers.byTexture} exaggeration=${exaggeration} look=${look} moving=${moving} canvas=${canvas} onMode=${setMode}/>`}
      ${layers && !heights_um && html`<p role="status">${t("result.map.empty")}</p>`}
      <span class="hidden" role="img" aria-label=${summary}></span>
    </div>
    <p>${t(mode === "relief" ? "result.view3d.relief" : "result.view3d.stated", { n: number(exaggeration) })}</p>
    <p class="buttons">
      ${button(t("result.view3d.left"), () => ({ turn_deg: look.turn_deg - 15 }))}${button(t("result.view3d.right"), () => ({ turn_deg: look.turn_deg + 15 }))}
      ${button(t("result.view3d.up"), () => ({ tilt_deg: look.tilt_deg + 15 }))}${button(t("result.view3d.down"), () => ({ tilt_deg: look.tilt_deg - 15 }))}
      ${button(t("result.zoom_in"), () => ({ zoom: look.zoom * 1.25 }))}${button(t("result.zoom_out"), () => ({ zoom: look.zoom / 1.25 }))}
      ${button(t("result.view3d.above"), () => ({ turn_deg: 0, tilt_deg: 90, zoom: 1 }))}${button(t("result.view3d.reset"), () => kFirstLook)}
    </p>
    <p id="view3d-keys" class="help">${t("result.view3d.keys")}</p>
  </section>`;
}
