// A form's fields from the daemon's own description of a method: what it takes is written down once, there.

export interface Schema {
  type?: string;
  enum?: string[];
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  default?: unknown;
  description?: string;
  items?: Schema;
  properties?: Record<string, Schema>;
  required?: string[];
  minItems?: number;
  "x-unit"?: string;
}

export interface Param {
  name: string;
  description?: string;
  required?: boolean;
  schema: Schema;
}

export interface Method {
  name: string;
  summary?: string;
  params: Param[];
  "x-role"?: string;
}

export type Kind = "number" | "integer" | "text" | "choice" | "flag" | "job" | "jobs" | "rows" | "region" | "study";

export interface Field {
  name: string;
  kind: Kind;
  about: string;
  required: boolean;
  unit: string;
  minimum: number | null;   // the smallest that is accepted, or below all that are (isOpen)
  isOpen: boolean;          // the minimum itself is refused
  maximum: number | null;
  fallback: unknown;        // what holds where nothing is given; undefined = nothing
  options: string[];
  columns: Field[];         // of rows
  least: number;            // rows or jobs
}

const kJobNames = new Set(["job", "second_job", "up", "down"]);
const kStudyNames = new Set(["study", "type1", "rr"]);

function kindOf(name: string, schema: Schema): Kind {
  if (schema.enum) return "choice";
  if (schema.type === "boolean") return "flag";
  if (schema.type === "number" || schema.type === "integer") return schema.type;
  if (schema.type === "array") return schema.items?.type === "object" ? "rows" : "jobs";
  if (schema.type === "object") return "region";
  if (kJobNames.has(name)) return "job";
  return kStudyNames.has(name) ? "study" : "text";
}

// The unit is in a key's name where the schema does not say it: radius_um.
function unitOf(name: string, schema: Schema): string {
  if (schema["x-unit"]) return schema["x-unit"];
  return /_(um|mm|ms|us|deg|db)$/.exec(name)?.[1] ?? "";
}

function fieldOf(name: string, schema: Schema, required: boolean, about: string): Field {
  const kind = kindOf(name, schema);
  const inner = schema.items;
  return {
    name, kind, about, required,
    unit: unitOf(name, schema),
    minimum: schema.minimum ?? schema.exclusiveMinimum ?? null,
    isOpen: schema.minimum === undefined && schema.exclusiveMinimum !== undefined,
    maximum: schema.maximum ?? null,
    fallback: schema.default,
    options: schema.enum ?? [],
    columns: kind === "rows" ? Object.entries(inner?.properties ?? {}).map(([column, each]) =>
      fieldOf(column, each, (inner?.required ?? []).includes(column), each.description ?? "")) : [],
    least: schema.minItems ?? 1,
  };
}

export const fieldsOf = (method: Method): Field[] =>
  method.params.map(({ name, schema, required = false, description = "" }) => fieldOf(name, schema, required, description || schema.description || ""));

// "0 < … ≤ 10": a limit that nobody meets in practice is no help and is left out.
export function rangeText({ minimum, maximum, isOpen }: Field, told: (value: number) => string): string {
  const isFar = (value: number | null): boolean => value === null || Math.abs(value) >= 1e6;
  const low = isFar(minimum) ? "" : `${told(minimum ?? 0)} ${isOpen ? "<" : "≤"} `;
  const high = isFar(maximum) ? "" : ` ≤ ${told(maximum ?? 0)}`;
  return low || high ? `${low}…${high}` : "";
}
