// Results and part ids as nobody wishes for them: what components draw of each.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { type SmallElement, drawn } from "./small_document.ts";
import { loadTexts, setLanguage } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { link } from "../../../daemon/web/src/live/live.ts";
import { JobTable } from "../../../daemon/web/src/pages/history/job_table.ts";
import { ValuePairs } from "../../../daemon/web/src/pages/recipe/value_pairs.ts";
import { Conditions } from "../../../daemon/web/src/pages/result/conditions.ts";
import { Downloads } from "../../../daemon/web/src/pages/result/downloads.ts";
import { MeasurementTable } from "../../../daemon/web/src/pages/result/measurement_table.ts";
import { NoResult } from "../../../daemon/web/src/pages/result/no_result.ts";
import { ResultHead } from "../../../daemon/web/src/pages/result/result_head.ts";
import { summaryText } from "../../../daemon/web/src/pages/result/summary_text.ts";
import { ValueTable } from "../../../daemon/web/src/pages/run/value_table.ts";
import { HeightMap } from "../../../daemon/web/src/parts/height_map.ts";
import { MapPicture } from "../../../daemon/web/src/parts/map_picture.ts";
import type { ResultJson } from "../../../daemon/web/src/result/result_json.ts";
import { valuesOf } from "../../../daemon/web/src/results/values.ts";
import { rowsOf } from "../../../daemon/web/src/run/value_rows.ts";

before(async () => {
  await setLanguage("en");
  await loadTexts();
});

const kNoPoint = {
  job: { job_id: "20261130-1", seq: 1, part_id: "P 1", recipe: "groove" },
  verdict: "invalid",
  values: { points: 100, valid_points: 0, valid_fraction: 0, height: { min_um: null, max_um: null, mean_um: null, median_um: null }, hole_points: { low_prominence: 100 } },
  measurements: { height_min: { kind: "height", value: null, unit: "um" } },
  evaluation: {
    order: ["step", "land"],
    measurements: {
      // As the daemon writes them: with limits a value says why it is none, without limits there are no values.
      step: {
        kind: "step_height", main_value: "height_um", reason: "no valid point", points: 0, valid_fraction: 0, verdict: "invalid",
        values: { height_um: { unit: "um", reason: "no valid point", limits: { lower: 49.5, upper: 50.5 }, verdict: "invalid" } },
      },
      land: { kind: "areal", reason: "0 % of the region is valid", points: 0, valid_fraction: 0, values: {} },
    },
  },
} as unknown as ResultJson;

// A map of 4 x 2 without a height.
function noHeights(): ArrayBuffer {
  const bytes = new ArrayBuffer(32 + 4 * 8);
  new Uint32Array(bytes, 0, 8).set([0x48445646, 1, 4, 2, 1, 1, 4, 2]);
  new Float32Array(bytes, 32).fill(NaN);
  return bytes;
}

async function until(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise((done) => setTimeout(done, 1));
}

const table = (result: ResultJson): SmallElement => drawn(html`<${MeasurementTable} result=${result} shown=${null} onShow=${() => undefined}/>`);
const rowNamed = (all: SmallElement, name: string): SmallElement => {
  const row = all.all("tr").find((each) => each.text.includes(name));
  assert.ok(row, `no row ${name} in ${all.text}`);
  return row;
};

test("a map without a valid point says so, in words, without a bar of colours", async () => {
  globalThis.fetch = (async () => new Response(noHeights(), { status: 200 })) as typeof fetch;
  link.set({ status: "open", since_ms: 0 });
  const map = drawn(html`<${HeightMap} jobId="20261130-1" pitch=${{ x: 1, y: 1 }} noPointReason="Most: too little contrast."/>`);
  await until(() => map.all("figure").length > 0);
  assert.match(map.all(".picture-says")[0]?.text ?? "", /No point of the map has a height\. Most: too little contrast\./);
  assert.match(map.all("canvas")[0]?.given.get("aria-label") ?? "", /No point of the map has a height/);
  assert.equal(map.all(".map-colour-bar").length, 0);
  assert.doesNotMatch(map.text, /NaN|Infinity|null|undefined/);

  assert.match(summaryText(kNoPoint), /100/);
  const picture = drawn(html`<${MapPicture} values=${new Float32Array(8).fill(NaN)} width=${4} height=${2} range=${null} digits=${2} label="nothing"/>`);
  assert.equal(picture.all(".bar-of-colours").length, 0);
});

test("where all values are invalid each has its reason, on the run page and on the result's", () => {
  const run = drawn(html`<${ValueTable} rows=${rowsOf(kNoPoint)}/>`);
  assert.match(rowNamed(run, "height").text, /no valid point.*Invalid/);
  assert.match(rowNamed(run, "land").text, /0 % of the region is valid/, "a measurement without limits is not left out");
  assert.equal(run.all("svg").filter((each) => each.given.get("class") === "limit-bar").length, 0, "without a value there is no bar");
  assert.doesNotMatch(run.text, /NaN|null|undefined/);

  const result = table(kNoPoint);
  assert.match(rowNamed(result, "height /").text, /–.*49\.5 … 50\.5.*no valid point/);
  assert.match(rowNamed(result, "land").text, /0 % of the region is valid/);
  assert.doesNotMatch(result.text, /NaN|null|undefined/);

  const pairs = drawn(html`<${ValuePairs} before=${valuesOf(kNoPoint)} after=${valuesOf(kNoPoint)} heads=${["A", "B"]}/>`);
  assert.match(pairs.text, /no valid point/);
  assert.doesNotMatch(pairs.text, /NaN|null|undefined/);
});

const kBare = {
  ...kNoPoint,
  verdict: "uncertain",
  measurements: { valid_fraction: { kind: "fraction", value: 0.07, unit: "1", limits: { lower: 0.9, upper: null }, verdict: "fail" } },
  evaluation: {
    order: ["width"],
    measurements: {
      width: {
        kind: "step_height", main_value: "width_um", points: 9, valid_fraction: 1, verdict: "uncertain",
        values: { width_um: { value: 90.25, unit: "um", limits: { lower: 80 }, verdict: "uncertain" } },
      },
    },
  },
} as unknown as ResultJson;

test("a value without U says that U is not known, and has no interval", () => {
  const run = drawn(html`<${ValueTable} rows=${rowsOf(kBare)}/>`);
  const row = rowNamed(run, "width");
  assert.match(row.text, /90\.250 µm/);
  assert.equal(row.all("path").filter((each) => (each.given.get("class") ?? "").includes("interval")).length, 0);
  assert.doesNotMatch(row.text, /±/);
  assert.match(rowNamed(table(kBare), "width /").text, /90\.250 ?unknown/);
});

test("a tolerance without upper limit has one limit, and is open above", () => {
  const row = rowNamed(drawn(html`<${ValueTable} rows=${rowsOf(kBare)}/>`), "width");
  assert.equal(row.all("line").filter((each) => each.given.get("class") === "limit").length, 1);
  const [allowed] = row.all("rect");
  assert.equal(Number(allowed?.given.get("x")) + Number(allowed?.given.get("width")), 200, "to the bar's end");
  assert.match(row.text, /80/);
  assert.match(rowNamed(table(kBare), "width /").text, /≥ 80/);
});

test("a verdict of the map itself stands among the values, in percent", () => {
  const run = rowNamed(drawn(html`<${ValueTable} rows=${rowsOf(kBare)}/>`), "points with a height");
  assert.match(run.text, /7 %.*90 %/);
  const result = rowNamed(table(kBare), "points with a height");
  assert.match(result.text, /7.*≥ 90.*Fail/);
  assert.doesNotMatch(`${run.text} ${result.text}`, /null|undefined|NaN/);
});

const kParts = ['<script>alert(1)</script>"\'&', "x".repeat(200), "\u05d0\u05d1\u05d2 12 \u202e21", "../../etc/passwd", "=1+1"];

test("whatever a part is called is text, apart from the text beside it", () => {
  for (const part_id of kParts) {
    const result = { ...kNoPoint, job: { ...kNoPoint.job, part_id } };
    const row = { job_id: "20261130-1", seq: 1, client: "plc", part_id, recipe: "groove", state: "completed", verdict: "pass", ended_utc: "2026-11-30T10:00:00.000Z", error: "" };
    const status = { part_id, done: true, state: "failed", progress: 0, error: "stage_lost", error_code: 1111, error_message: "the stage is lost" };
    for (const all of [
      drawn(html`<${ResultHead} result=${result} ended_utc="2026-11-30T10:00:00Z"/>`),
      drawn(html`<${JobTable} rows=${[row]} chosen=${[]} onChoose=${() => undefined}/>`),
      drawn(html`<${NoResult} id="20261130-1" status=${status}/>`),
    ]) {
      assert.deepEqual(all.all("bdi").map((each) => each.childNodes.map((node) => node.markup).join("")).includes(
        part_id.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;")), true, all.markup);
      assert.equal(all.all("script").length, 0);
    }
  }
});

test("a folder of a result is named, and no link leads to it", () => {
  const result = { ...kNoPoint, files: [{ name: "slices", files: 16, size_bytes: 100 }, { name: "height.tiff", state: "written", size_bytes: 2048 }, { name: "report.pdf", state: "not_made", reason: "disk" }] } as ResultJson;
  const all = drawn(html`<${Downloads} result=${result}/>`);
  assert.deepEqual(all.all("a").map((each) => each.text), ["height.tiff", "result.json"]);
  assert.match(all.text, /slices.*16/);
  assert.match(all.text, /report\.pdf.*could not be made: disk/);
});

test("conditions that are not known say so, and the objective is told", () => {
  const bare = drawn(html`<${Conditions} result=${kNoPoint}/>`);
  assert.doesNotMatch(bare.text, /NaN|null|undefined/);
  assert.match(drawn(html`<${Conditions} result=${{ ...kNoPoint, objective: "20x/0.45" } as ResultJson}/>`).text, /20x\/0\.45/);
});
