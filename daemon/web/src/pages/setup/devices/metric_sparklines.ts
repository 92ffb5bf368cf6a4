// Metrics as small curves: form and newest value, from what was told since this tab was opened.
import { number, t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { usefulDigits } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { healthHistory, seriesOf } from "../../../live/health_history.ts";
import { Sparkline } from "./sparkline.ts";

interface Metric {
  path: string;
  unit: string;
  isCounter?: boolean;
  scale?: number;
}

const kMetrics: readonly Metric[] = [
  { path: "stage.latency_p50_us", unit: "µs" },
  { path: "stage.latency_p99_us", unit: "µs" },
  { path: "stage.requests", unit: "1/s", isCounter: true },
  { path: "stage.retries", unit: "1/s", isCounter: true },
  { path: "camera.frames_complete", unit: "1/s", isCounter: true },
  { path: "camera.frames_failed", unit: "1/s", isCounter: true },
  { path: "camera.packets_resent", unit: "1/s", isCounter: true },
  { path: "camera.packets_missing", unit: "1/s", isCounter: true },
  { path: "disk.free_bytes", unit: "GB", scale: 1e-9 },
];

export function MetricSparklines() {
  useLanguage();
  const samples = useStore(healthHistory);
  const known = samples.at(-1)?.values ?? {};
  const temperatures = Object.keys(known).filter((path) => path.startsWith("stage.temperatures_c.")).map((path) => ({ path, unit: "°C" }));
  const metrics: readonly Metric[] = [...kMetrics, ...temperatures].filter(({ path }) => path in known);
  return html`<section class="panel" aria-labelledby="metrics-title">
    <h2 id="metrics-title">${t("setup.metrics.title")}</h2>
    <p class="help">${t("setup.metrics.help")}</p>
    <ul class="metrics">${metrics.map(({ path, unit, isCounter = false, scale = 1 }) => {
      const series = seriesOf(samples, path, isCounter).map(([at_s, value]): [number, number] => [at_s, value * scale]);
      const last = series.at(-1)?.[1];
      const name = tWord("setup.metric", path.replace("stage.temperatures_c.", t("setup.metrics.temperature")));
      return html`<li key=${path}><span class="name">${name}</span>
        <${Sparkline} points=${series} label=${name}/>
        <span class="number">${last === undefined ? "–" : `${number(last, usefulDigits(last, 3))} ${unit}`}</span></li>`;
    })}</ul>
  </section>`;
}
