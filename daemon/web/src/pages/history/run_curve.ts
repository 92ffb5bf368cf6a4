// The curve of a run chart, drawn by uPlot; whiskers and marks are drawn over it.
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Centre, Mark } from "../../history/control_rules.ts";
import { number, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { ground, theme } from "../../lib/theme.ts";
import type { ValuePoint } from "../../rpc/listed.ts";

interface Props {
  points: readonly ValuePoint[];
  marks: readonly Mark[];
  centre: Centre | null;
  unit: string;
  label: string;
}

const kHeight_px = 320;

function extent(points: readonly ValuePoint[], centre: Centre | null): [number, number] {
  const all = points.flatMap(({ value, U, lower, upper }) => [value === null ? null : value - (U ?? 0), value === null ? null : value + (U ?? 0), lower, upper]);
  if (centre) all.push(centre.mean - 3 * centre.sigma, centre.mean + 3 * centre.sigma);
  const known = all.filter((each): each is number => each !== null && Number.isFinite(each));
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const margin = known.length === 0 ? 1 : (high - low) * 0.08 || Math.abs(high) * 0.01 || 1;
  return known.length === 0 ? [0, 1] : [low - margin, high + margin];
}

// Over the curve: U of each value, and what the rules mark.
function draw(plot: uPlot, { points, marks, centre }: Props, colour: (name: string) => string): void {
  const { ctx } = plot;
  const ratio = uPlot.pxRatio;
  const x = (i: number): number => plot.valToPos(i + 1, "x", true);
  const y = (value: number): number => plot.valToPos(value, "y", true);
  const line = (x0: number, y0: number, x1: number, y1: number): void => {
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1, y1);
    ctx.stroke();
  };
  ctx.save();
  ctx.lineWidth = ratio;
  if (centre) {
    ctx.strokeStyle = colour("--quiet");
    for (const times of [-3, 0, 3]) {
      ctx.setLineDash(times === 0 ? [] : [6 * ratio, 4 * ratio]);
      const at = y(centre.mean + times * centre.sigma);
      line(plot.bbox.left, at, plot.bbox.left + plot.bbox.width, at);
    }
    ctx.setLineDash([]);
  }
  points.forEach(({ value, U }, i) => {
    if (value === null) return;
    const at = { x: x(i), y: y(value) };
    if (U !== null) {
      ctx.strokeStyle = colour("--accent");
      line(at.x, y(value - U), at.x, y(value + U));
      for (const end of [value - U, value + U]) line(at.x - 3 * ratio, y(end), at.x + 3 * ratio, y(end));
    }
    ctx.strokeStyle = colour("--bad");
    ctx.lineWidth = 2 * ratio;
    const size = 8 * ratio;
    const shape = (corners: readonly (readonly [number, number])[]): void => {
      ctx.beginPath();
      for (const [dx, dy] of corners) ctx.lineTo(at.x + dx * size, at.y + dy * size);
      ctx.closePath();
      ctx.stroke();
    };
    if (marks[i]?.rule1) shape([[0, -1], [1, 0], [0, 1], [-1, 0]]);
    if (marks[i]?.rule4) shape([[0, -1.2], [1.1, 0.8], [-1.1, 0.8]]);
    ctx.lineWidth = ratio;
  });
  ctx.restore();
}

export function RunCurve(props: Props) {
  const language = useLanguage();
  const colours = useStore(theme);
  const holder = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const at = holder.current;
    if (!at) return;
    at.dataset["ground"] = ground();
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string): string => style.getPropertyValue(name).trim();
    const { points, unit } = props;
    const axis = { stroke: colour("--text"), grid: { stroke: colour("--line"), width: 0.5 }, ticks: { stroke: colour("--line") }, font: "13px system-ui" };
    const stepped = uPlot.paths.stepped?.({ align: 1 });
    const limit = { stroke: colour("--warn"), width: 2, points: { show: false }, ...(stepped ? { paths: stepped } : {}) };
    const plot = new uPlot({
      width: at.clientWidth,
      height: kHeight_px,
      legend: { show: false },
      cursor: { y: false },
      scales: { x: { time: false, range: [0.5, points.length + 0.5] }, y: { range: extent(points, props.centre) } },
      axes: [
        { ...axis, values: (_, splits) => splits.map((i) => (Number.isInteger(i) ? points[i - 1]?.ended_utc.slice(5, 16).replace("T", " ") ?? "" : "")), space: 110 },
        { ...axis, size: 80, label: unit, values: (_, splits) => splits.map((value) => number(Number(value.toPrecision(9)))) },
      ],
      series: [
        {},
        { stroke: colour("--accent"), width: 1, points: { show: points.length <= 500, size: 7, fill: colour("--accent") } },
        limit,
        limit,
      ],
      hooks: { draw: [(drawn) => draw(drawn, props, colour)] },
    }, [points.map((_, i) => i + 1), points.map((point) => point.value), points.map((point) => point.lower), points.map((point) => point.upper)], at);
    const resized = new ResizeObserver(() => plot.setSize({ width: at.clientWidth, height: kHeight_px }));
    resized.observe(at);
    return () => {
      resized.disconnect();
      plot.destroy();
    };
  }, [props.points, props.unit, language, colours]);
  return html`<div ref=${holder} class="curve plot-of" role="img" aria-label=${props.label}></div>`;
}
