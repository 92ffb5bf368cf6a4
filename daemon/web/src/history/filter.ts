// What of the history is asked for, as it stands in the page's address.
import type { JobFilter } from "../rpc/listed.ts";

export interface Wanted {
  part: string;
  recipe: string;
  verdict: string;
  from: string;  // a day, YYYY-MM-DD, in UTC
  to: string;
  text: string;
}

const kNames = ["part", "recipe", "verdict", "from", "to", "text"] as const;

// One that the calendar has: some browsers take 30 February for 2 March.
function isDay(text: string): boolean {
  const day = new Date(`${text}T00:00:00.000Z`);
  return /^\d{4}-\d\d-\d\d$/.test(text) && !Number.isNaN(day.getTime()) && day.toISOString().startsWith(text);
}

export function wantedOf(query: URLSearchParams): Wanted {
  const get = (name: (typeof kNames)[number]): string => query.get(name) ?? "";
  return { part: get("part"), recipe: get("recipe"), verdict: get("verdict"), from: get("from"), to: get("to"), text: get("text") };
}

export function addressOf(wanted: Wanted): string {
  const given = kNames.filter((name) => wanted[name] !== "").map((name) => [name, wanted[name]]);
  return given.length === 0 ? "/jobs" : `/jobs?${new URLSearchParams(given)}`;
}

// The words of job.list; "none" = nothing was judged.
export const kVerdicts = ["pass", "fail", "uncertain", "invalid", "none"] as const;
const kLongestText_bytes = 64;  // as the daemon counts them: UTF-8
const kBytes = new TextEncoder();

// As many whole characters from the beginning as fit.
function cut(text: string): string {
  let bytes = 0;
  let kept = "";
  for (const character of text) {
    bytes += kBytes.encode(character).length;
    if (bytes > kLongestText_bytes) break;
    kept += character;
  }
  return kept;
}

const verdictOf = (word: string): (typeof kVerdicts)[number] | undefined => kVerdicts.find((each) => each === word);

// What the database seeks. What an address says that the daemon would refuse is left out, or cut.
export function filterOf(wanted: Wanted): JobFilter {
  const verdict = verdictOf(wanted.verdict);
  const text = cut(wanted.text.trim());
  return {
    ...(wanted.part ? { part_id: cut(wanted.part) } : {}),
    ...(wanted.recipe ? { recipe: cut(wanted.recipe) } : {}),
    ...(verdict ? { verdict } : {}),
    ...(isDay(wanted.from) ? { from_utc: `${wanted.from}T00:00:00.000Z` } : {}),
    ...(isDay(wanted.to) ? { to_utc: `${wanted.to}T23:59:59.999Z` } : {}),
    ...(text ? { text } : {}),
  };
}
