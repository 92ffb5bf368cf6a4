// One value over the last jobs, with its limits, its uncertainty and what the control rules say.
import { useEffect, useState } from "preact/hooks";
import { number, t } from "../../i18n/i18n.ts";
import { centreOf, marksOf } from "../../history/control_rules.ts";
import { csvOf } from "../../history/csv.ts";
import { digitsOf } from "../../lib/digits.ts";
import { download } from "../../lib/download.ts";
import { html } from "../../lib/html.ts";
import { shownUnit } from "../../lib/units.ts";
import { messageOf } from "../../parts/message_of.ts";
import { valuesOf } from "../../results/values.ts";
import type { JobRow, ValuePoint } from "../../rpc/listed.ts";
import { call } from "../../rpc/rpc.ts";
import { RunCurve } from "./run_curve.ts";
import { RunTable } from "./run_table.ts";

const kCounts = [20, 50, 100, 200, 500, 1000, 2000] as const;

interface Choice {
  measurement: string;
  name: string;
  unit: string;
}

const keyOf = (choice: Choice): string => JSON.stringify([choice.measurement, choice.name]);

export function RunChart({ rows, recipe }: { rows: readonly JobRow[]; recipe: string }) {
  const [choices, setChoices] = useState<Choice[]>([]);
  const [chosen, setChosen] = useState("");
  const [most, setMost] = useState(100);
  const [points, setPoints] = useState<ValuePoint[] | null>(null);
  const [searchedAll, setSearchedAll] = useState(true);
  const [problem, setProblem] = useState("");
  const newest = rows.find((row) => row.state === "completed" && (!recipe || row.recipe === recipe))?.job_id ?? "";

  // What the newest result has is what can be drawn.
  useEffect(() => {
    if (!newest) return;
    let ended = false;
    call("result.get", { job_id: newest, format: "complete" }).then(({ result }) => {
      if (!ended) setChoices(valuesOf(result).map(({ measurement, name, unit }) => ({ measurement, name, unit })));
    }, (error) => { if (!ended) setProblem(messageOf(error)); });
    return () => { ended = true; };
  }, [newest]);

  const choice = choices.find((each) => keyOf(each) === chosen) ?? choices[0];
  const key = choice ? keyOf(choice) : "";
  useEffect(() => {
    if (!choice) return;
    let ended = false;
    call("value.list", { measurement: choice.measurement, value: choice.name, most, ...(recipe ? { recipe } : {}) }).then((got) => {
      if (ended) return;
      setPoints(got.points);
      setSearchedAll(got.searched_all);
      setProblem("");
    }, (error) => { if (!ended) setProblem(messageOf(error)); });
    return () => { ended = true; };
  }, [key, most, recipe, newest]);

  const values = points?.map((point) => point.value) ?? [];
  const centre = centreOf(values);
  const marks = marksOf(values, centre);
  const unit = shownUnit(choice?.unit ?? "");
  const take = (): void => {
    if (!choice || !points) return;
    const head = ["job_id", "part_id", "ended_utc", choice.name, "U", "lower", "upper", "verdict", "rule_1", "rule_4"];
    download(`${choice.measurement}_${choice.name}.csv`.replace(/[^A-Za-z0-9_.-]/g, "_"), "text/csv", csvOf(head, points.map((point, i) => [
      point.job_id, point.part_id, point.ended_utc, point.value, point.U, point.lower, point.upper, point.verdict,
      marks[i]?.rule1 ? 1 : 0, marks[i]?.rule4 ? 1 : 0,
    ])));
  };
  const digits = centre ? digitsOf(centre.mean, centre.sigma || null) : 3;
  return html`<section class="panel run-chart" aria-labelledby="run-chart">
    <h2 id="run-chart">${t("history.chart")}</h2>
    <div class="filter">
      <label>${t("history.value")} <select value=${key} onChange=${(event: Event) => setChosen((event.target as HTMLSelectElement).value)}>
        ${choices.map((each) => html`<option value=${keyOf(each)}>${each.measurement}: ${each.name}</option>`)}</select></label>
      <label>${t("history.last_jobs")} <select value=${String(most)} onChange=${(event: Event) => setMost(Number((event.target as HTMLSelectElement).value))}>
        ${kCounts.map((count) => html`<option value=${String(count)}>${count}</option>`)}</select></label>
      <button type="button" disabled=${!points?.length} onClick=${take}>${t("history.csv_chart")}</button>
    </div>
    ${!recipe && html`<p class="help">${t("history.all_recipes")}</p>`}
    ${!searchedAll && html`<p class="help">${t("history.newest_only", { count: 20000 })}</p>`}
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${choices.length === 0 && html`<p>${t("history.nothing")}</p>`}
    ${points && points.length > 0 && html`
      <${RunCurve} points=${points} marks=${marks} centre=${centre} unit=${unit} label=${t("history.chart_label", {
        value: choice?.name ?? "", count: points.length,
        first: marks.filter((mark) => mark.rule1).length, fourth: marks.filter((mark) => mark.rule4).length,
      })}/>
      <p>${centre
        ? t("history.centre", { mean: `${number(centre.mean, digits)} ${unit}`, sigma: `${number(centre.sigma, digits)} ${unit}`, count: centre.count })
        : t("history.no_centre")}</p>
      <ul class="legend">
        <li><span class="key value" aria-hidden="true">●</span> ${t("history.key_value")}</li>
        <li><span class="key limit" aria-hidden="true">━</span> ${t("history.key_limit")}</li>
        <li><span class="key centre" aria-hidden="true">┅</span> ${t("history.key_centre")}</li>
        <li><span class="key rule" aria-hidden="true">◇</span> ${t("history.key_rule1")}</li>
        <li><span class="key rule" aria-hidden="true">△</span> ${t("history.key_rule4")}</li>
      </ul>
      <${RunTable} points=${points} marks=${marks} unit=${unit}/>`}
  </section>`;
}
