// The map in 2D: what it shows, its colours, and what is under the cursor.
import { useMemo, useState } from "preact/hooks";
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import type { Shape } from "../../result/fitted_geometry.ts";
import type { ResultJson } from "../../result/result_json.ts";
import { percentileRange, wholeRange } from "../../surface/colour_range.ts";
import type { Range } from "../../surface/colours.ts";
import type { Point } from "../../surface/full_map.ts";
import type { Kind, Tile } from "../../surface/height_tile.ts";
import type { Place, ProfileLine } from "../../surface/profile_line.ts";
import { ColourBar, HoleLegend } from "./colour_bar.ts";
import type { Plane } from "./map_canvas.ts";
import { MapStage } from "./map_stage.ts";
import { NumberField } from "./number_field.ts";
import { Readout } from "./readout.ts";
import { type ResultMap, useOverview } from "./use_map.ts";

type RangeMode = "p99" | "p95" | "whole" | "hand";

const kShares: Record<"p99" | "p95", [number, number]> = { p99: [0.005, 0.995], p95: [0.025, 0.975] };
const kKinds: readonly Kind[] = ["height", "sigma", "texture", "reason"];
const perMetre = (kind: Kind): number => (kind === "texture" || kind === "reason" ? 1 : 1e6);

// In the unit that is shown; null where nothing is valid.
function rangeOf(tile: Tile, mode: RangeMode, hand: Range | null): Range | null {
  if (mode === "hand") return hand;
  if (tile.kind === "reason") return { low: 0, high: 1 };
  const found = mode === "whole" ? wholeRange(tile.lowest, tile.highest) : percentileRange(tile.mean, ...kShares[mode]);
  const scale = perMetre(tile.kind);
  return found && { low: found.low * scale, high: found.high * scale };
}

interface Props {
  result: ResultJson;
  map: ResultMap;
  summary: string;
  shapes: Shape[];
  line: ProfileLine;
  marks: Place[];
  onLine: (line: ProfileLine) => void;
}

export function MapPanel({ result, map, summary, shapes, line, marks, onLine }: Props) {
  const [kind, setKind] = useState<Kind>("height");
  const [mode, setMode] = useState<RangeMode>("p99");
  const [hand, setHand] = useState<Partial<Record<Kind, Range>>>({});
  const [plane, setPlane] = useState<Plane>("mean");
  const [factor, setFactor] = useState(1);
  const [problem, setProblem] = useState("");
  const [cursor, setCursor] = useState<{ at: Point | null; byKeyboard: boolean }>({ at: null, byKeyboard: false });
  const { tile, error } = useOverview(map.full.job, kind);
  const unit = kind === "height" || kind === "sigma" ? "µm" : "";
  // All values are sorted for it, which is too much for every move of the pointer.
  const automatic = useMemo(() => tile && rangeOf(tile, mode === "hand" ? "p99" : mode, null), [tile, mode]);
  const range = (mode === "hand" && hand[kind]) || automatic;
  const digits = kind === "texture" ? 0 : range && range.high - range.low < 1 ? 4 : 2;
  const moveCursor = (at: Point | null, byKeyboard: boolean): void =>
    setCursor((before) => (before.at?.column === at?.column && before.at?.row === at?.row && before.byKeyboard === byKeyboard ? before : { at, byKeyboard }));
  const byHand = (change: Partial<Range>): void => {
    const next = { ...(range ?? { low: 0, high: 1 }), ...change };
    setHand({ ...hand, [kind]: next });
    setMode("hand");
  };
  return html`<section class="panel map-panel" aria-labelledby="map-title">
    <h2 id="map-title">${t("result.map.title")}</h2>
    <div class="controls">
      <label>${t("result.shows")}
        <select value=${kind} onChange=${(event: Event) => setKind((event.target as HTMLSelectElement).value as Kind)}>
          ${kKinds.map((each) => html`<option value=${each}>${tWord("result.kind", each)}</option>`)}
        </select></label>
      ${kind !== "reason" && html`<label>${t("result.range")}
        <select value=${mode} onChange=${(event: Event) => {
          const next = (event.target as HTMLSelectElement).value as RangeMode;
          if (next === "hand" && range) byHand({});
          else setMode(next);
        }}>
          ${(["p99", "p95", "whole", "hand"] as const).map((each) => html`<option value=${each}>${tWord("result.range", each)}</option>`)}
        </select></label>
      ${range && html`<${NumberField} label=${t("result.range.low")} unit=${unit} value=${range.low} digits=${digits} onChange=${(low: number) => byHand({ low })}/>
        <${NumberField} label=${t("result.range.high")} unit=${unit} value=${range.high} digits=${digits} onChange=${(high: number) => byHand({ high })}/>`}`}
      ${factor > 1 && (kind === "height" || kind === "sigma") && html`<label>${t("result.plane")}
        <select value=${plane} onChange=${(event: Event) => setPlane((event.target as HTMLSelectElement).value as Plane)}>
          ${(["mean", "lowest", "highest"] as const).map((each) => html`<option value=${each}>${tWord("result.plane", each)}</option>`)}
        </select></label>`}
    </div>
    ${Boolean(error) && html`<p class="problem" role="alert">${messageOf(error)}</p>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    <p id="map-summary" class="help">${summary}</p>
    ${tile && !range && html`<p role="status">${t("result.map.empty")}</p>`}
    ${tile && html`<${MapStage} map=${map} overview=${tile} plane=${plane} summary=${summary} shapes=${shapes} line=${line} marks=${marks} cursor=${cursor.at}
      range=${range ? { low: range.low / perMetre(kind), high: range.high / perMetre(kind) } : { low: 0, high: 1 }}
      onCursor=${moveCursor} onLine=${onLine} onFactor=${setFactor}
      onError=${(failed: unknown) => setProblem(messageOf(failed))}/>`}
    <${Readout} map=${map} cursor=${cursor.at} byKeyboard=${cursor.byKeyboard}/>
    ${factor > 1 && html`<p class="help">${t("result.reduced", { n: number(factor) })}</p>`}
    ${kind === "reason"
      ? html`<${HoleLegend} counts=${result.values?.hole_points ?? {}} points=${result.values?.points ?? 0}/>`
      : range && html`<${ColourBar} kind=${kind} range=${range} unit=${unit}/>`}
  </section>`;
}
