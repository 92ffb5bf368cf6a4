// A number while it is typed. It goes into the document with every key: a drawing in between, which comes with each event of the station, then finds in
// the document what stands in the input, and never sets it back. What is no number goes there as it was typed: the daemon's checker says what it expects.
import { number } from "../../../i18n/i18n.ts";
import { readNumber } from "../../../lib/read_number.ts";
import type { Json } from "../../../recipe/schema.ts";

export function valueOfText(text: string): Json | undefined {
  if (text.trim() === "") return undefined;
  const value = readNumber(text);
  // JSON text does not keep the sign of -0, and "-0" is on its way to "-0.5".
  return value === null ? text : value + 0;
}

export function textOfValue(value: Json | undefined): string {
  if (value === undefined) return "";
  return typeof value === "number" ? number(value) : typeof value === "string" ? value : JSON.stringify(value);
}

// "1," is on its way to "1,5": what was typed stands as long as it means what the document has.
export const shownText = (typed: string, value: Json | undefined): string =>
  Object.is(valueOfText(typed), value) ? typed : textOfValue(value);

// Two numbers that belong together, one of them typed. An emptied one keeps its place as long as the other is there: else the other would move into it.
export function pairWith(pair: readonly Json[], i: 0 | 1, text: string): Json[] {
  const next: (Json | undefined)[] = [pair[0], pair[1]].map((each) => (each === "" ? undefined : each));
  next[i] = valueOfText(text);
  const [first, second] = next;
  if (second === undefined) return first === undefined ? [] : [first];
  return [first ?? "", second];
}
