// The values of a result.json, in the recipe's order.
import { type JsonObject, isObject } from "../recipe/schema.ts";

export interface Value {
  measurement: string;
  name: string;
  value: number | null;  // null = there is none; reason says why
  unit: string;
  U: number | null;      // null = not known
  lower: number | null;
  upper: number | null;
  verdict: string | null;
  reason: string;
}

const kNothing: JsonObject = {};
const numberOr = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);
const textOr = (value: unknown): string => (typeof value === "string" ? value : "");

export function valuesOf(result: unknown): Value[] {
  if (!isObject(result)) return [];
  const evaluation = result["evaluation"];
  const found: Value[] = [];
  if (isObject(evaluation) && isObject(evaluation["measurements"])) {
    const all = evaluation["measurements"];
    const order = Array.isArray(evaluation["order"]) ? evaluation["order"].map(String) : Object.keys(all);
    for (const measurement of order) {
      const about = Object.hasOwn(all, measurement) ? all[measurement] : undefined;
      if (!isObject(about) || !isObject(about["values"])) continue;
      // A measurement that failed as a whole has no values; what it should have given is missing for its reason.
      const own = Object.entries(about["values"]);
      for (const [name, each] of own.length > 0 ? own : [[textOr(about["main_value"]) || measurement, kNothing] as const]) {
        if (!isObject(each)) continue;
        const limits = isObject(each["limits"]) ? each["limits"] : kNothing;
        found.push({
          measurement,
          name,
          value: numberOr(each["value"]),
          unit: textOr(each["unit"]),
          U: numberOr(each["U"]),
          lower: numberOr(limits["lower"]),
          upper: numberOr(limits["upper"]),
          verdict: typeof each["verdict"] === "string" ? each["verdict"] : own.length === 0 && typeof about["verdict"] === "string" ? about["verdict"] : null,
          reason: textOr(each["reason"]) || (own.length === 0 ? textOr(about["reason"]) : ""),
        });
      }
    }
  }
  // Without an evaluation a result still tells of the map as a whole.
  if (found.length === 0 && isObject(result["measurements"])) {
    for (const [name, each] of Object.entries(result["measurements"])) {
      if (!isObject(each)) continue;
      found.push({ measurement: "map", name, value: numberOr(each["value"]), unit: textOr(each["unit"]), U: null, lower: null, upper: null, verdict: null, reason: "" });
    }
  }
  return found;
}

export interface Pair {
  measurement: string;
  name: string;
  before: Value | null;
  after: Value | null;
}

// Values of two results side by side: those of the second in its order, then those that only the first has.
export function pairs(before: readonly Value[], after: readonly Value[]): Pair[] {
  const keyOf = (value: Value): string => JSON.stringify([value.measurement, value.name]);
  const old = new Map(before.map((value) => [keyOf(value), value]));
  const both = after.map((value) => {
    const key = keyOf(value);
    const was = old.get(key) ?? null;
    old.delete(key);
    return { measurement: value.measurement, name: value.name, before: was, after: value };
  });
  return [...both, ...[...old.values()].map((value) => ({ measurement: value.measurement, name: value.name, before: value, after: null }))];
}
