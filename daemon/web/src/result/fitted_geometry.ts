// What a measurement fitted, as shapes to draw into the map: in µm, y down.
import type { CrossSection, Measurement } from "./result_json.ts";

export interface Place {
  x: number;
  y: number;
}

export interface Shape {
  kind: "band" | "region" | "section" | "unmeasured" | "notch" | "s_point";
  name: string;
  points: Place[];  // a polygon, a line of two, or a place
}

interface Frame {
  along: Place;
  across: Place;
  length: number;
}

function frameOf(section: CrossSection): Frame {
  const dx = section.to_x_um - section.from_x_um;
  const dy = section.to_y_um - section.from_y_um;
  const length = Math.hypot(dx, dy) || 1;
  const along = { x: dx / length, y: dy / length };
  return { along, across: { x: -along.y, y: along.x }, length };
}

// The part of a section's band between two places along it.
function bandPart(section: CrossSection, from_um: number, to_um: number): Place[] {
  const { along, across } = frameOf(section);
  const half = section.band_width_um / 2;
  const corner = (at: number, side: number): Place => ({
    x: section.from_x_um + along.x * at + across.x * side * half,
    y: section.from_y_um + along.y * at + across.y * side * half,
  });
  return [corner(from_um, -1), corner(to_um, -1), corner(to_um, 1), corner(from_um, 1)];
}

// Where straight flanks end and the rounding begins: the model is flank, rounding in short steps, flank.
export function sPoints(measurement: Measurement): { along_um: number; z_um: number }[] {
  if (measurement.kind !== "cutting_edge") return [];
  return (measurement.cross_section?.fit ?? []).flatMap(({ along_um, z_um }) => {
    if (along_um.length < 5) return [];  // flanks alone
    return [1, along_um.length - 2].map((i) => ({ along_um: along_um[i] ?? NaN, z_um: z_um[i] ?? NaN }));
  });
}

export function shapesOf(measurement: Measurement): Shape[] {
  const shapes: Shape[] = [];
  const section = measurement.cross_section;
  if (section) {
    const { along, length } = frameOf(section);
    shapes.push({ kind: "band", name: "", points: bandPart(section, 0, length) });
    for (const { name, from_um, to_um } of section.regions) {
      shapes.push({ kind: "region", name, points: bandPart(section, from_um, to_um) });
    }
    for (const { along_um } of sPoints(measurement)) {
      shapes.push({ kind: "s_point", name: "S", points: [{ x: section.from_x_um + along.x * along_um, y: section.from_y_um + along.y * along_um }] });
    }
    // Sections of an edge lie as the one that is shown does, each about its own place.
    const rounding = section.regions.length === 2 ? section.regions : null;
    const reach = rounding ? ((rounding[1]?.to_um ?? 0) - (rounding[0]?.from_um ?? 0)) / 2 : length / 2;
    for (const { x_um, y_um, unmeasured } of measurement.details?.sections ?? []) {
      shapes.push({
        kind: unmeasured ? "unmeasured" : "section", name: unmeasured ?? "",
        points: [{ x: x_um - along.x * reach, y: y_um - along.y * reach }, { x: x_um + along.x * reach, y: y_um + along.y * reach }],
      });
    }
  }
  for (const { x_um, y_um } of measurement.details?.chipping?.notches ?? []) {
    shapes.push({ kind: "notch", name: "", points: [{ x: x_um, y: y_um }] });
  }
  return shapes;
}
