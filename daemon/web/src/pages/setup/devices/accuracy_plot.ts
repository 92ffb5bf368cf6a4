// How exactly the stage went where it was sent, over all scans: mean, spread, 95 % and worst on one scale.
import { useEffect, useState } from "preact/hooks";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { usefulDigits } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { results } from "../../../live/live.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { call } from "../../../rpc/rpc.ts";
import { Problem } from "../problem.ts";
import { type Accuracy, type Row, rowsOf } from "./accuracy_rows.ts";

function Scale({ row }: { row: Row }) {
  const { middle, spread, marks } = row;
  const ends = [0, middle, middle - (spread ?? 0), middle + (spread ?? 0), ...marks.map(([, at]) => at)];
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const at = (value: number): number => 8 + (284 * (value - low)) / (high - low || 1);
  const told = (value: number): string => `${number(value, usefulDigits(value, 3))} ${row.unit}`;
  return html`<div class="accuracy"><h3>${row.name}</h3>
    <svg viewBox="0 0 300 40" aria-hidden="true">
      <line class="rail" x1="8" x2="292" y1="24" y2="24"/>
      <line class="zero" x1=${at(0)} x2=${at(0)} y1="8" y2="38"/>
      ${spread !== null && html`<rect class="spread" x=${at(middle - spread)} width=${Math.max(1, at(middle + spread) - at(middle - spread))} y="17" height="14"/>`}
      <line class="middle" x1=${at(middle)} x2=${at(middle)} y1="12" y2="36"/>
      ${marks.map(([, value], i) => html`<path class="mark" d=${i === marks.length - 1 ? `M${at(value)} 24 l-6 -10 h12 z` : `M${at(value) - 5} 19 h10 v10 h-10 z`}/>`)}
    </svg>
    <p class="reading">${spread === null ? t("setup.accuracy.median", { value: told(middle) }) : t("setup.accuracy.mean", { value: told(middle), sd: told(spread) })}
      ${marks.map(([mark, value], i) => html` · <span aria-hidden="true">${i === marks.length - 1 ? "▼" : "■"}</span> ${mark} ${told(value)}`)}</p>
  </div>`;
}

export function AccuracyPlot() {
  useLanguage();
  const { count } = useStore(results);
  const [accuracy, setAccuracy] = useState<Accuracy | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    let gone = false;
    call("stage.accuracy", {}).then(
      (told) => {
        if (gone) return;
        setAccuracy(told);
        setProblem("");
      },
      (error: unknown) => gone || setProblem(messageOf(error)));
    return () => void (gone = true);
  }, [count]);
  const rows = accuracy ? rowsOf(accuracy, { position: t("setup.accuracy.position"), step: t("setup.accuracy.step"), time: t("setup.accuracy.time"),
    p95: t("setup.accuracy.p95"), max: t("setup.accuracy.max") }) : [];
  return html`<section class="panel" aria-labelledby="accuracy-title">
    <h2 id="accuracy-title">${t("setup.accuracy.title")}</h2>
    ${accuracy && html`<p class="help">${t("setup.accuracy.of", { scans: accuracy.scans, steps: accuracy.steps, lost: accuracy.lost_steps })}</p>`}
    ${accuracy && accuracy.scans > 0 && !accuracy.observable && html`<p class="help">${t("setup.accuracy.blind")}</p>`}
    ${rows.map((row) => html`<${Scale} key=${row.name} row=${row}/>`)}
    <${Problem} text=${problem}/>
  </section>`;
}
