// Changes of a JSON document that leave everything else as it is: keys that the form does not know and the order of keys survive.
import { type Json, isObject } from "./schema.ts";

export type Path = readonly string[];

export const pointerOf = (path: Path): string => path.map((step) => `/${step.replaceAll("~", "~0").replaceAll("/", "~1")}`).join("");

export const pathOf = (pointer: string): string[] =>
  pointer === "" ? [] : pointer.slice(1).split("/").map((step) => step.replaceAll("~1", "/").replaceAll("~0", "~"));

// Own keys only: a document may have a key "constructor" or "__proto__".
const child = (value: Json | undefined, step: string): Json | undefined => {
  if (Array.isArray(value)) return value[Number(step)];
  return isObject(value) && Object.hasOwn(value, step) ? value[step] : undefined;
};

export function getAt(document: Json | undefined, path: Path): Json | undefined {
  let value = document;
  for (const step of path) value = child(value, step);
  return value;
}

// Objects on the way are made where they are missing.
export function setAt(document: Json | undefined, path: Path, value: Json): Json {
  const [step, ...rest] = path;
  if (step === undefined) return value;
  const inner = setAt(child(document, step), rest, value);
  if (Array.isArray(document)) {
    const copy = [...document];
    copy[Number(step)] = inner;
    return copy;
  }
  const entries = isObject(document) ? Object.entries(document) : [];
  const at = entries.findIndex(([key]) => key === step);
  if (at < 0) entries.push([step, inner]);
  else entries[at] = [step, inner];
  return Object.fromEntries(entries);
}

// What is around it stays, even when nothing is left in it.
export function removeAt(document: Json, path: Path): Json {
  const [step, ...rest] = path;
  if (step === undefined || child(document, step) === undefined) return document;
  if (rest.length > 0) return setAt(document, [step], removeAt(child(document, step) as Json, rest));
  if (Array.isArray(document)) return document.filter((_, i) => i !== Number(step));
  return isObject(document) ? Object.fromEntries(Object.entries(document).filter(([key]) => key !== step)) : document;
}

// The key keeps its place among its neighbours; a name that another one has changes nothing.
export function renameAt(document: Json, path: Path, name: string): Json {
  const above = path.slice(0, -1);
  const old = path[path.length - 1];
  const holder = getAt(document, above);
  if (old === undefined || !isObject(holder) || name === old || Object.hasOwn(holder, name)) return document;
  return setAt(document, above, Object.fromEntries(Object.entries(holder).map(([key, each]) => [key === old ? name : key, each])));
}

// A name that the object does not have yet.
export function freeName(holder: Json | undefined, wanted: string): string {
  if (!isObject(holder) || !Object.hasOwn(holder, wanted)) return wanted;
  for (let i = 2; ; ++i) if (!Object.hasOwn(holder, `${wanted}_${i}`)) return `${wanted}_${i}`;
}
