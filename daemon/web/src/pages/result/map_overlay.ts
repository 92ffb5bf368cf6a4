// What is drawn over the map: fitted geometry, the profile's line with its ends, the cursor, a scale bar.
import { number, t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { Shape } from "../../result/fitted_geometry.ts";
import { type MapSize, type Size, type View, middleOf, toScreen } from "../../surface/map_view.ts";
import type { Point } from "../../surface/full_map.ts";
import type { Place, ProfileLine } from "../../surface/profile_line.ts";
import { barLength } from "../../surface/ticks.ts";

interface Props {
  map: MapSize;
  unit: string;
  view: View;
  canvas: Size;
  shapes: Shape[];
  line: ProfileLine;
  cursor: Point | null;
  marks: Place[];  // the profile's cursors
}

const kHandle = 11;

function Shapes({ shapes, at }: { shapes: Shape[]; at: (place: Place) => Place }) {
  return shapes.map(({ kind, name, points }) => {
    const screen = points.map(at);
    const first = screen[0];
    if (!first) return null;
    if (kind === "s_point") {
      return html`<g class="shape s_point"><circle cx=${first.x} cy=${first.y} r="5"/><text x=${first.x + 7} y=${first.y - 6}>${name}</text></g>`;
    }
    if (kind === "notch") return html`<path class="shape notch" d=${`M${first.x - 8} ${first.y - 8}l16 16m0 -16l-16 16`}/>`;
    const d = `M${screen.map(({ x, y }) => `${x} ${y}`).join("L")}${screen.length > 2 ? "Z" : ""}`;
    // Beside the first border, where the profile's line does not run.
    const [a, b] = [first, screen[1] ?? first];
    return html`<g class=${`shape ${kind}`}><path d=${d}/>${kind === "region" && html`<text x=${(a.x + b.x) / 2} y=${Math.max(16, (a.y + b.y) / 2 + 16)} text-anchor="middle">${name}</text>`}</g>`;
  });
}

export function MapOverlay({ map, unit, view, canvas, shapes, line, cursor, marks }: Props) {
  const at = (place: Place): Place => toScreen(view, canvas, place);
  const [from, to] = [at(line.from), at(line.to)];
  const length = Math.hypot(line.to.x - line.from.x, line.to.y - line.from.y) || 1;
  const half = (line.width_um / 2) * view.scale;
  const across = { x: (-(line.to.y - line.from.y) / length) * half, y: ((line.to.x - line.from.x) / length) * half };
  const band = [[from, 1], [to, 1], [to, -1], [from, -1]] as const;
  const here = cursor && at(middleOf(map, cursor));
  const bar = barLength((canvas.width * 0.3) / view.scale);
  return html`<svg class="map-overlay" viewBox=${`0 0 ${canvas.width} ${canvas.height}`} aria-hidden="true">
    <${Shapes} shapes=${shapes} at=${at}/>
    ${half > 1 && html`<path class="profile-band" d=${`M${band.map(([{ x, y }, side]) => `${x + side * across.x} ${y + side * across.y}`).join("L")}Z`}/>`}
    <path class="profile-line under" d=${`M${from.x} ${from.y}L${to.x} ${to.y}`}/>
    <path class="profile-line" d=${`M${from.x} ${from.y}L${to.x} ${to.y}`}/>
    ${marks.map((mark, i) => {
      const place = at(mark);
      return html`<g class="profile-mark"><circle cx=${place.x} cy=${place.y} r="5"/><text x=${place.x + 7} y=${place.y - 7}>${i + 1}</text></g>`;
    })}
    ${([["A", from], ["B", to]] as const).map(([name, { x, y }]) => html`<g class="profile-end">
      <circle cx=${x} cy=${y} r=${kHandle}/><text x=${x} y=${y + 4.5} text-anchor="middle">${name}</text></g>`)}
    ${here && html`<path class="cursor under" d=${`M${here.x - 14} ${here.y}h28M${here.x} ${here.y - 14}v28`}/>
      <path class="cursor" d=${`M${here.x - 14} ${here.y}h28M${here.x} ${here.y - 14}v28`}/>`}
    <g class="scale-bar" transform=${`translate(12 ${canvas.height - 14})`}>
      <rect class="ground" x="-6" y="-24" width=${bar * view.scale + 12} height="34" rx="4"/>
      <path d=${`M0 0h${bar * view.scale}`}/><text x=${(bar * view.scale) / 2} y="-7" text-anchor="middle">${t("result.length", { value: number(bar), unit })}</text>
    </g>
  </svg>`;
}
