// A region or surface by another name: whatever names it follows, or measurements would point to what is not there any more.
import { type Path, getAt, renameAt, setAt } from "./document.ts";
import { type Json, type JsonObject, isObject } from "./schema.ts";

type Change = (value: Json) => Json;

// Of those keys that are there; the others, and the order of all, stay.
const at = (keys: readonly string[], change: Change): Change => (value) =>
  isObject(value) ? Object.fromEntries(Object.entries(value).map(([key, each]) => [key, keys.includes(key) ? change(each) : each])) : value;

const each = (change: Change): Change => (value) =>
  Array.isArray(value) ? value.map(change) : isObject(value) ? Object.fromEntries(Object.entries(value).map(([key, one]) => [key, change(one)])) : value;

// "levels" has limits by pairs of its regions, the later one above the earlier one.
function renamePairs(measurement: JsonObject, name: (region: string) => string): JsonObject {
  const { kind, regions, limits } = measurement;
  if (kind !== "levels" || !Array.isArray(regions) || !isObject(limits)) return measurement;
  const names = regions.map(String);
  const keys = new Map<string, string>(names.flatMap((lower, i) => names.slice(i + 1).map((upper) => [`${upper}-${lower}_um`, `${name(upper)}-${name(lower)}_um`] as const)));
  return { ...measurement, limits: Object.fromEntries(Object.entries(limits).map(([key, value]) => [keys.get(key) ?? key, value])) };
}

// A name that another one has changes nothing.
export function renameWithUses(document: Json, path: Path, to: string): Json {
  const renamed = renameAt(document, path, to);
  const [section, kind, from] = path;
  const evaluation = getAt(renamed, ["evaluation"]);
  if (renamed === document || getAt(document, path) === undefined || section !== "evaluation" || path.length !== 3 || evaluation === undefined) return renamed;
  const name: Change = (value) => (value === from ? to : value);
  let uses: Change;
  if (kind === "regions") {
    const ofMeasurement = at(["lower", "upper", "region"], name);
    const measurement: Change = (value) => at(["regions"], each(name))(isObject(value) ? renamePairs(ofMeasurement(value) as JsonObject, (region) => name(region) as string) : value);
    const region: Change = (value) => at(["not"], name)(at(["union", "intersection"], each(name))(value));
    const surface = at(["steps"], each(at(["regions"], each(name))));
    uses = (value) => at(["measurements"], each(measurement))(at(["regions"], each(region))(at(["surfaces"], each(surface))(value)));
  } else if (kind === "surfaces") {
    uses = (value) => at(["measurements"], each(at(["surface"], name)))(at(["surfaces"], each(at(["from"], name)))(value));
  } else {
    return renamed;
  }
  return setAt(renamed, ["evaluation"], uses(evaluation));
}
