// What was typed into a study's form, as the daemon takes it, or which fields are not right yet.
import { readNumber } from "../../../lib/read_number.ts";
import type { Field } from "./study_fields.ts";

export interface Region {
  shape: "" | "rectangle_um" | "circle_um";
  numbers: Record<string, string>;  // as typed
}

export type Row = Record<string, string>;
export type Value = string | boolean | string[] | Row[] | Region;
export type Values = Record<string, Value>;
export type Fault = "missing" | "no_number" | "no_integer" | "too_small" | "too_large" | "too_few";
export type Faults = Record<string, Fault>;  // by field, "steps.0.reference_um" in rows, "region.x" in a region

export const kRegionNumbers: Record<Exclude<Region["shape"], "">, readonly string[]> = {
  rectangle_um: ["x", "y", "width", "height"],
  circle_um: ["x", "y", "radius"],
};

export function emptyValue(field: Field): Value {
  switch (field.kind) {
    case "flag": return field.fallback === true;
    case "jobs": return [];
    case "rows": return [emptyRow(field)];
    case "region": return { shape: "", numbers: {} };
    case "choice": return typeof field.fallback === "string" ? field.fallback : field.options[0] ?? "";
    default: return "";
  }
}

export const emptyRow = (field: Field): Row =>
  Object.fromEntries(field.columns.map(({ name, fallback }) => [name, typeof fallback === "string" ? fallback : ""]));

function faultOfNumber(text: string, field: Field): Fault | null {
  const value = readNumber(text);
  if (value === null) return "no_number";
  if (field.kind === "integer" && !Number.isInteger(value)) return "no_integer";
  if (field.minimum !== null && (field.isOpen ? value <= field.minimum : value < field.minimum)) return "too_small";
  return field.maximum !== null && value > field.maximum ? "too_large" : null;
}

// A text field's content for the daemon; undefined = nothing was typed, the daemon's own default holds.
function takeText(field: Field, text: string, at: string, faults: Faults): unknown {
  if (text.trim() === "") {
    if (field.required) faults[at] = "missing";
    return undefined;
  }
  if (field.kind !== "number" && field.kind !== "integer") return text.trim();
  const fault = faultOfNumber(text, field);
  if (fault === null) return readNumber(text);
  faults[at] = fault;
  return undefined;
}

function takeRegion(region: Region, at: string, faults: Faults): unknown {
  if (region.shape === "") return undefined;
  const numbers: Record<string, number> = {};
  for (const name of kRegionNumbers[region.shape]) {
    const value = readNumber(region.numbers[name] ?? "");
    if (value === null) faults[`${at}.${name}`] = "no_number";
    else if (value <= 0 && name !== "x" && name !== "y") faults[`${at}.${name}`] = "too_small";
    else numbers[name] = value;
  }
  return { [region.shape]: numbers };
}

function takeRows(field: Field, rows: Row[], faults: Faults): unknown[] {
  if (rows.length < field.least) faults[field.name] = "too_few";
  return rows.map((row, i) => {
    const made: Record<string, unknown> = {};
    for (const column of field.columns) {
      const value = takeText(column, row[column.name] ?? "", `${field.name}.${i}.${column.name}`, faults);
      if (value !== undefined) made[column.name] = value;
    }
    return made;
  });
}

export function paramsOf(fields: readonly Field[], values: Values): { params: Record<string, unknown>; faults: Faults } {
  const params: Record<string, unknown> = {};
  const faults: Faults = {};
  for (const field of fields) {
    const value = values[field.name] ?? emptyValue(field);
    let taken: unknown;
    if (field.kind === "flag") taken = value === field.fallback ? undefined : value;
    else if (field.kind === "jobs") {
      taken = value;
      if ((value as string[]).length < field.least) faults[field.name] = "too_few";
    } else if (field.kind === "rows") taken = takeRows(field, value as Row[], faults);
    else if (field.kind === "region") taken = takeRegion(value as Region, field.name, faults);
    else taken = takeText(field, value as string, field.name, faults);
    if (taken !== undefined) params[field.name] = taken;
  }
  return { params, faults };
}
