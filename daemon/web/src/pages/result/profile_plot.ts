// The curve of a profile: height with the band of its standard error, gaps where there are holes, two cursors, what was
// fitted, and the regions of the measurement that is shown.
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { number, t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { ground, theme } from "../../lib/theme.ts";
import type { CrossSection } from "../../result/result_json.ts";
import { type CircleFit, type LineFit, fittedAt } from "../../surface/profile_fits.ts";
import type { Profile } from "../../surface/profile_line.ts";
import { useWidth } from "./use_size.ts";

export interface Cursors {
  first: number;  // µm along the profile
  second: number;
}

interface Props {
  profile: Profile;
  unit: string;
  cursors: Cursors;
  fit: LineFit | CircleFit | null;
  section: CrossSection | null;  // of the measurement along whose line the profile was taken
  s_points: { along_um: number; z_um: number }[];
  onCursors: (cursors: Cursors) => void;
}

const kHeight = 300;

// Of another curve on the profile's own places; null beside it.
function onPlaces(distance: readonly number[], curve: { along_um: number[]; z_um: number[] }): (number | null)[] {
  let i = 0;
  return distance.map((at) => {
    const { along_um, z_um } = curve;
    while (i + 2 < along_um.length && (along_um[i + 1] ?? Infinity) < at) ++i;
    const [a, b] = [along_um[i], along_um[i + 1]];
    if (a === undefined || b === undefined || at < a || at > b || !(b > a)) return null;
    const [za, zb] = [z_um[i] ?? NaN, z_um[i + 1] ?? NaN];
    return za + ((zb - za) * (at - a)) / (b - a);
  });
}

const colourOf = (element: Element, name: string): string => getComputedStyle(element).getPropertyValue(name).trim() || "#888";

export function ProfilePlot(props: Props) {
  const holder = useRef<HTMLDivElement>(null);
  const width = useWidth(holder);
  const language = useLanguage();
  const colours = useStore(theme);
  const latest = useRef(props);
  latest.current = props;
  const plot = useRef<uPlot | null>(null);
  const { profile, fit, section, cursors, s_points, unit } = props;

  useEffect(() => {
    const element = holder.current;
    if (!element || width < 50) return;
    element.dataset["ground"] = ground();
    const text = colourOf(element, "--text");
    const accent = colourOf(element, "--accent");
    const focus = colourOf(element, "--focus");
    const good = colourOf(element, "--good");
    const line = colourOf(element, "--line");
    const { distance_um, height_um, sigma_um } = profile;
    const edge = (side: number): (number | null)[] => height_um.map((z, i) => {
      const sigma = sigma_um[i];
      return z === null || sigma === null || sigma === undefined || Number.isNaN(sigma) ? null : z + side * sigma;
    });
    const fits = section?.fit ?? [];
    const data: uPlot.AlignedData = [
      distance_um, height_um, edge(1), edge(-1),
      distance_um.map((x) => (fit && x >= Math.min(cursors.first, cursors.second) && x <= Math.max(cursors.first, cursors.second) ? fittedAt(fit, x) : null)),
      ...fits.map((curve) => onPlaces(distance_um, curve)),
    ];
    const axis = (label: string): uPlot.Axis => ({
      label, stroke: text, font: "13px system-ui, sans-serif", labelFont: "13px system-ui, sans-serif", grid: { stroke: line, width: 0.5 }, ticks: { stroke: line },
      values: (_, values) => values.map((value) => (value === null ? "" : number(Number(value.toPrecision(8))))),
    });
    const marks = (u: uPlot): void => {
      const { ctx, bbox } = u;
      ctx.save();
      ctx.beginPath();
      ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
      ctx.clip();
      const scale = devicePixelRatio || 1;
      ctx.font = `${13 * scale}px system-ui, sans-serif`;
      ctx.textAlign = "center";
      for (const { name, from_um, to_um } of latest.current.section?.regions ?? []) {
        const [a, b] = [u.valToPos(from_um, "x", true), u.valToPos(to_um, "x", true)];
        ctx.globalAlpha = 0.14;
        ctx.fillStyle = good;
        ctx.fillRect(a, bbox.top, b - a, bbox.height);
        ctx.globalAlpha = 1;
        ctx.fillStyle = text;
        ctx.fillText(name, (a + b) / 2, bbox.top + 16 * scale);
      }
      for (const { along_um, z_um } of s_points) {
        const [x, y] = [u.valToPos(along_um, "x", true), u.valToPos(z_um, "y", true)];
        ctx.fillStyle = focus;
        ctx.beginPath();
        ctx.arc(x, y, 4 * scale, 0, 2 * Math.PI);
        ctx.fill();
        ctx.fillText("S", x, y - 8 * scale);
      }
      const { first, second } = latest.current.cursors;
      [first, second].forEach((at, i) => {
        const x = u.valToPos(at, "x", true);
        ctx.strokeStyle = ctx.fillStyle = focus;
        ctx.lineWidth = 2 * scale;
        ctx.setLineDash(i === 0 ? [] : [6 * scale, 4 * scale]);
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
        ctx.fillText(String(i + 1), x + 9 * scale, bbox.top + bbox.height - 6 * scale);
      });
      ctx.restore();
    };
    const made = new uPlot({
      width, height: kHeight, legend: { show: false },
      scales: { x: { time: false, range: [0, (distance_um.at(-1) ?? 1) + (distance_um[0] ?? 0)] } },
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      axes: [axis(t("result.axis.along", { unit })), { ...axis(t("result.axis.height")), size: 70 }],
      series: [
        {},
        { stroke: accent, width: 1.5, spanGaps: false, points: { show: distance_um.length < 60 } },
        { stroke: accent, width: 0.5, spanGaps: false, points: { show: false } },
        { stroke: accent, width: 0.5, spanGaps: false, points: { show: false } },
        { stroke: focus, width: 2, spanGaps: false, points: { show: false } },
        ...fits.map((): uPlot.Series => ({ stroke: good, width: 2, dash: [7, 4], spanGaps: false, points: { show: false } })),
      ],
      bands: [{ series: [2, 3], fill: line }],
      hooks: { draw: [marks] },
    }, data, element);
    plot.current = made;
    let held: keyof Cursors | null = null;
    const place = (event: PointerEvent): number => {
      const at = made.posToVal(event.clientX - made.over.getBoundingClientRect().left, "x");
      return Math.max(0, Math.min((distance_um.at(-1) ?? 0) + (distance_um[0] ?? 0), at));
    };
    const down = (event: PointerEvent): void => {
      const at = place(event);
      const { first, second } = latest.current.cursors;
      held = Math.abs(at - first) <= Math.abs(at - second) ? "first" : "second";
      made.over.setPointerCapture(event.pointerId);
      latest.current.onCursors({ ...latest.current.cursors, [held]: at });
    };
    const move = (event: PointerEvent): void => {
      if (held) latest.current.onCursors({ ...latest.current.cursors, [held]: place(event) });
    };
    const up = (): void => void (held = null);
    made.over.addEventListener("pointerdown", down);
    made.over.addEventListener("pointermove", move);
    made.over.addEventListener("pointerup", up);
    made.over.addEventListener("pointercancel", up);
    return () => {
      plot.current = null;
      made.destroy();
    };
  }, [profile, width, language, colours, section, fit, unit]);

  useEffect(() => plot.current?.redraw(false), [cursors.first, cursors.second]);
  return html`<div ref=${holder} class="profile-plot plot-of" role="img" aria-label=${t("result.profile.plot", { points: profile.distance_um.length })}></div>`;
}
