// The recipe's regions over a picture: lines that are seen on dark and on bright, names beside them.
import { html } from "../../lib/html.ts";
import type { Shape } from "../../run/regions.ts";

function outline(shape: Shape) {
  switch (shape.kind) {
    case "rectangle": return html`<rect x=${shape.x} y=${shape.y} width=${shape.width} height=${shape.height}/>`;
    case "circle": return html`<circle cx=${shape.x} cy=${shape.y} r=${shape.radius}/>`;
    case "polygon": return html`<polygon points=${shape.points.map((point) => point.join(",")).join(" ")}/>`;
    case "line": return html`<polyline points=${shape.points.map((point) => point.join(",")).join(" ")}/>`;
  }
}

// Where the name stands: at the shape's upper left.
function corner(shape: Shape): { x: number; y: number } {
  switch (shape.kind) {
    case "rectangle": return shape;
    case "circle": return { x: shape.x - shape.radius, y: shape.y - shape.radius };
    default: return { x: Math.min(...shape.points.map(([x]) => x)), y: Math.min(...shape.points.map(([, y]) => y)) };
  }
}

const percent = (part: number): string => `${Math.min(95, Math.max(0, part * 100))}%`;

export function RegionOverlay({ shapes, width_um, height_um }: { shapes: readonly Shape[]; width_um: number; height_um: number }) {
  return html`<div class="regions" aria-hidden="true">
    <svg viewBox=${`0 0 ${width_um} ${height_um}`} preserveAspectRatio="none" fill="none">
      ${["under", "over"].map((layer) => html`<g class=${layer}>${shapes.map(outline)}</g>`)}
    </svg>
    ${shapes.map((shape) => {
      const { x, y } = corner(shape);
      return html`<span style=${{ left: percent(x / width_um), top: percent(y / height_um) }}>${shape.name}</span>`;
    })}
  </div>`;
}
