// Two jobs beside each other: maps in the same colours, values, and the difference of the maps.
import { useEffect, useState } from "preact/hooks";
import { number, t } from "../../i18n/i18n.ts";
import { type Difference, differenceOf, extremes, whyNotComparable } from "../../history/map_difference.ts";
import { html } from "../../lib/html.ts";
import { MapPicture } from "../../parts/map_picture.ts";
import { messageOf } from "../../parts/message_of.ts";
import { VerdictLabel } from "../../parts/verdict_mark.ts";
import { isObject, type JsonObject } from "../../recipe/schema.ts";
import { call } from "../../rpc/rpc.ts";
import { percentDigits } from "../../result/value_text.ts";
import { valuesOf } from "../../results/values.ts";
import type { Range } from "../../surface/colours.ts";
import { percentileRange, wholeRange } from "../../surface/colour_range.ts";
import { type Tile, fetchTile } from "../../surface/height_tile.ts";
import { type WholeMap, fetchWholeMap } from "../../surface/whole_map.ts";
import { pitchOf } from "../recipe/newest_job.ts";
import { ValuePairs } from "../recipe/value_pairs.ts";
import "../../style/history.css";
import "../../style/recipe.css";

const kMost_px = 640;  // of a picture; the difference is computed of all points

interface Side {
  job_id: string;
  result: JsonObject;
  map: WholeMap;
  picture: Tile;  // means of blocks
}

async function load(job_id: string, signal: AbortSignal): Promise<Side> {
  const { result } = await call("result.get", { job_id, format: "complete" }, { signal });
  if (!isObject(result)) throw new Error(t("history.no_result", { job: job_id }));
  const picture = await fetchTile(job_id, "height", null, kMost_px, signal);
  const map = picture.factor === 1 ? { width: picture.width, height: picture.height, values: picture.mean } : await fetchWholeMap(job_id, picture, signal);
  return { job_id, result, picture, map };
}

// A spike does not take the colours from everything else.
const middle = (values: Float32Array): Range | null => percentileRange(values, 0.005, 0.995);

function Maps({ sides }: { sides: readonly Side[] }) {
  const ranges = sides.map(({ map }) => middle(map.values)).filter((range) => range !== null);
  const range = ranges.length === 0 ? null : { low: Math.min(...ranges.map(({ low }) => low)), high: Math.max(...ranges.map(({ high }) => high)) };
  return html`<div class="side-by-side">${sides.map(({ job_id, result, map, picture }, i) => {
    const valid = map.values.reduce((count, value) => count + (Number.isNaN(value) ? 0 : 1), 0);
    const whole = wholeRange(map.values, map.values);
    const um = (metres: number): string => number(metres * 1e6, 2);
    const verdict = result["verdict"];
    const job = result["job"];
    return html`<section class="panel" key=${job_id}>
      <h2>${i === 0 ? "A" : "B"}: <a href=${`/jobs/${encodeURIComponent(job_id)}`}>${job_id}</a></h2>
      <p><bdi>${isObject(job) ? String(job["part_id"] ?? "") : ""}</bdi> · ${isObject(job) ? String(job["recipe"] ?? "") : ""} · <${VerdictLabel} verdict=${typeof verdict === "string" ? verdict : null}/></p>
      <${MapPicture} values=${picture.mean} width=${picture.width} height=${picture.height} range=${range} digits=${2}
        label=${whole === null ? t("map.no_point") : t("history.map_label", { low: um(whole.low), high: um(whole.high), width: map.width, height: map.height, valid: percentDigits(valid / map.values.length) })}/>
    </section>`;
  })}</div>`;
}

function DifferenceMap({ difference, width }: { difference: Difference; width: number }) {
  const small = extremes(difference.values, width, kMost_px);
  const spread = middle(difference.values);
  const most = Math.max(Math.abs(spread?.low ?? 0), Math.abs(spread?.high ?? 0), 1e-12);
  const um = (metres: number): string => `${number(metres * 1e6, 3)} µm`;
  return html`
    <p>${t("history.aligned", {
      offset: um(difference.offset), slope_x: um(difference.slope_x * 1000), slope_y: um(difference.slope_y * 1000), points: difference.points,
    })}</p>
    <${MapPicture} values=${small.values} width=${small.width} height=${small.height} range=${{ low: -most, high: most }} parting digits=${3}
      label=${t("history.difference_label", { rms: um(difference.rms), least: um(difference.least), greatest: um(difference.greatest) })}/>
    <p class="help">${small.factor > 1 ? t("history.drawn_by_extremes", { factor: small.factor }) : t("history.not_resampled")}</p>`;
}

export function Comparison({ first, second }: { first: string; second: string }) {
  const [sides, setSides] = useState<Side[] | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    const ending = new AbortController();
    Promise.all([load(first, ending.signal), load(second, ending.signal)]).then(setSides, (error) => {
      if (!ending.signal.aborted) setProblem(messageOf(error));
    });
    return () => ending.abort();
  }, [first, second]);

  const [a, b] = sides ?? [];
  const shapes = [a, b].map((side) => {
    const pitch = pitchOf(side?.result ?? null);
    return side && pitch ? { width: side.map.width, height: side.map.height, pitch_x_um: pitch.x, pitch_y_um: pitch.y } : null;
  });
  const [one, other] = shapes;
  const refusal = one && other ? whyNotComparable(one, other) : null;
  const [difference, setDifference] = useState<Difference | null | undefined>(undefined);
  useEffect(() => {
    if (a && b && one && other && refusal === null) setDifference(differenceOf(a.map.values, b.map.values, a.map.width));
  }, [sides]);
  return html`<h1>${t("history.comparison")}</h1>
    <p><a href="/jobs">${t("history.back")}</a></p>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${!sides && !problem && html`<p aria-live="polite">${t("history.loading")}</p>`}
    ${sides && html`<${Maps} sides=${sides}/>`}
    ${a && b && html`<div class="side-by-side">
      <section class="panel"><h2>${t("history.difference")}</h2>
        ${!one || !other ? html`<p>${t("history.no_pitch")}</p>`
          : refusal === "size" ? html`<p>${t("history.refused_size", { a: `${one.width} × ${one.height}`, b: `${other.width} × ${other.height}` })}</p>`
          : refusal === "pitch" ? html`<p>${t("history.refused_pitch", { a: number(one.pitch_x_um), b: number(other.pitch_x_um) })}</p>`
          : difference === null ? html`<p>${t("history.no_common")}</p>`
          : difference && html`<${DifferenceMap} difference=${difference} width=${a.map.width}/>`}
      </section>
      <section class="panel"><h2>${t("history.values")}</h2>
        <${ValuePairs} before=${valuesOf(a.result)} after=${valuesOf(b.result)} heads=${["A", "B"]}/></section>
    </div>`}`;
}
