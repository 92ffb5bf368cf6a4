// The recipe schema as the form reads it. It is the repository's own file, so that a new key is in the form by itself.
import text from "../../../../config/recipe.schema.json" with { type: "json" };

export interface Schema {
  type?: "object" | "array" | "string" | "number" | "integer" | "boolean";
  description?: string;
  enum?: readonly string[];
  const?: string;
  default?: unknown;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  maxLength?: number;
  minItems?: number;
  maxItems?: number;
  properties?: Record<string, Schema>;
  required?: readonly string[];
  additionalProperties?: boolean | Schema;
  items?: Schema;
  oneOf?: readonly Schema[];
}

export const recipeSchema = text as unknown as Schema;

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type JsonObject = { [key: string]: Json };

export const isObject = (value: unknown): value is JsonObject => typeof value === "object" && value !== null && !Array.isArray(value);

// The key that tells which of several shapes an object has: a constant one ("kind", "op"), or one that only this shape requires ("circle_um").
export function nameOfShape(shape: Schema): string {
  for (const about of Object.values(shape.properties ?? {})) if (about.const !== undefined) return about.const;
  return shape.required?.[0] ?? "";
}

// Which of the shapes a value has; -1 where it has none of them.
export function shapeOf(shapes: readonly Schema[], value: unknown): number {
  if (!isObject(value)) return -1;
  return shapes.findIndex((shape) => {
    const constant = Object.entries(shape.properties ?? {}).find(([, about]) => about.const !== undefined);
    if (constant) return value[constant[0]] === constant[1].const;
    return (shape.required ?? []).every((key) => key in value);
  });
}

const kUnits: readonly (readonly [string, string])[] = [
  ["_um_per_s", "µm/s"], ["px_per_um_x", "px/µm"], ["px_per_um_y", "px/µm"], ["_um2", "µm²"], ["_um", "µm"], ["_ms", "ms"], ["_us", "µs"], ["_px", "px"], ["_db", "dB"],
  ["_deg", "°"], ["_per_k", "1/K"], ["_percent", "%"], ["_s", "s"],
];

// The unit that a key's name ends with; "" where it has none.
export function unitOf(key: string): string {
  return kUnits.find(([end]) => key.endsWith(end))?.[1] ?? "";
}

// A key for people: its words without the unit, the first in upper case.
export function labelOf(key: string): string {
  const unit = kUnits.find(([end]) => key.endsWith(end) && !end.startsWith("px_"))?.[0] ?? "";
  const words = key.slice(0, key.length - unit.length).replaceAll("_", " ").trim() || key;
  return words.charAt(0).toUpperCase() + words.slice(1);
}

// "3 … 63", "> 0 … 100"; "" where a schema has no bounds.
export function rangeOf(about: Schema, write: (value: number) => string): string {
  const low = about.exclusiveMinimum !== undefined ? `> ${write(about.exclusiveMinimum)}` : about.minimum !== undefined ? write(about.minimum) : "";
  const high = about.maximum !== undefined ? write(about.maximum) : "";
  if (low && high) return `${low} … ${high}`;
  return low || (high && `≤ ${high}`);
}

// What a new value of this schema begins as: its default, or the least that has its shape.
export function initialOf(about: Schema): Json {
  if (about.default !== undefined) return structuredClone(about.default) as Json;
  if (about.const !== undefined) return about.const;
  if (about.enum) return about.enum[0] ?? "";
  if (about.oneOf?.[0]) return initialOf(about.oneOf[0]);
  switch (about.type) {
    case "object": {
      const made: JsonObject = {};
      for (const key of about.required ?? []) made[key] = initialOf(about.properties?.[key] ?? {});
      return made;
    }
    case "array": return Array.from({ length: about.minItems ?? 0 }, () => initialOf(about.items ?? {}));
    case "boolean": return false;
    case "number":
    case "integer": return Math.max(about.minimum ?? 0, about.exclusiveMinimum !== undefined ? about.exclusiveMinimum + 1 : -Infinity, 0);
    default: return "";
  }
}
