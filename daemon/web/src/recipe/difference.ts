// What two documents do not have in common, value by value; how they are written does not count.
import { type Path, pointerOf } from "./document.ts";
import { type Json, isObject } from "./schema.ts";

export interface Change {
  pointer: string;
  before: Json | undefined;  // undefined = was not there
  after: Json | undefined;   // undefined = is not there any more
}

export function same(a: Json | undefined, b: Json | undefined): boolean {
  return differences(a, b).length === 0;
}

export function differences(before: Json | undefined, after: Json | undefined, at: Path = []): Change[] {
  if (isObject(before) && isObject(after)) {
    const keys = [...new Set([...Object.keys(before), ...Object.keys(after)])];
    return keys.flatMap((key) => differences(
      Object.hasOwn(before, key) ? before[key] : undefined,
      Object.hasOwn(after, key) ? after[key] : undefined,
      [...at, key],
    ));
  }
  const both = Array.isArray(before) && Array.isArray(after);
  if (both && before.length === after.length) return before.flatMap((each, i) => differences(each, after[i], [...at, String(i)]));
  if (!both && Object.is(before, after)) return [];
  if (typeof before === "number" && before === after) return [];  // 0 and -0
  return [{ pointer: pointerOf(at), before, after }];
}
