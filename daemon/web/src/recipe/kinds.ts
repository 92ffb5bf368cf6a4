// Measurements that the assistant offers, each with what it needs to begin.
import { freeName, getAt, type Path } from "./document.ts";
import { type StepHeight, kUnknownHeights } from "./region_heights.ts";
import { type Json, type JsonObject, isObject } from "./schema.ts";

export const kMeasurements = ["step_between", "step_height", "areal", "profile", "cutting_edge"] as const;
export type Measurement = (typeof kMeasurements)[number];

const regionsOf = (document: Json): string[] => {
  const regions = getAt(document, ["evaluation", "regions"]);
  return isObject(regions) ? Object.keys(regions) : [];
};

export function hasMeasurements(document: Json): boolean {
  const measurements = getAt(document, ["evaluation", "measurements"]);
  return isObject(measurements) && Object.keys(measurements).length > 0;
}

// How many regions it needs that are not there yet.
export function regionsMissing(kind: Measurement, document: Json): number {
  return kind === "step_between" ? Math.max(0, 2 - regionsOf(document).length) : 0;
}

// Of two regions the lower one is the one that the step is positive from, where heightOf() tells.
export function newMeasurement(kind: Measurement, document: Json, size_um: { x: number; y: number }, heightOf: StepHeight = kUnknownHeights): { path: Path; value: JsonObject } {
  const [first = "", second = ""] = regionsOf(document);
  const [lower, upper] = (heightOf(first, second) ?? 0) < 0 ? [second, first] : [first, second];
  const about: Record<Measurement, { name: string; value: JsonObject }> = {
    step_between: { name: "step", value: { kind, lower, upper } },
    step_height: { name: "step", value: { kind, method: "iso5436_a1", across: "x" } },
    areal: { name: "roughness", value: { kind, ...(first ? { region: first } : {}), parameters: ["Sa", "Sq", "Sz"] } },
    profile: {
      name: "profile",
      value: { kind, from_um: [Math.round(size_um.x * 0.1), Math.round(size_um.y / 2)], to_um: [Math.round(size_um.x * 0.9), Math.round(size_um.y / 2)], parameters: ["Ra", "Rz"] },
    },
    cutting_edge: { name: "edge", value: { kind, flank_um: [40, 80] } },
  };
  const { name, value } = about[kind];
  return { path: ["evaluation", "measurements", freeName(getAt(document, ["evaluation", "measurements"]), name)], value };
}

export const kNewRecipe: JsonObject = {
  format: 2,
  description: "",
  acquire: { scan: { start_um: 0, step_um: 10, slices: 21 }, camera: { pixel_format: "Mono8", exposure_us: 5000 } },
  reconstruct: { focus: { window_px: 9 }, lateral: { pixel_pitch_x_um: 1, pixel_pitch_y_um: 1 } },
};
