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
const isDay = (text: string): boolean => /^\d{4}-\d\d-\d\d$/.test(text);

export function wantedOf(query: URLSearchParams): Wanted {
  const get = (name: (typeof kNames)[number]): string => query.get(name) ?? "";
  return { part: get("part"), recipe: get("recipe"), verdict: get("verdict"), from: get("from"), to: get("to"), text: get("text") };
}

export function addressOf(wanted: Wanted): string {
  const query = new URLSearchParams(kNames.filter((name) => wanted[name] !== "").map((name) => [name, wanted[name]]));
  return query.size === 0 ? "/jobs" : `/jobs?${query}`;
}

// The words of job.list; "none" = nothing was judged.
export const kVerdicts = ["pass", "fail", "uncertain", "invalid", "none"] as const;
const kLongestText = 64;

const verdictOf = (word: string): (typeof kVerdicts)[number] | undefined => kVerdicts.find((each) => each === word);

// What the database seeks. What an address says that the daemon would refuse is left out, or cut.
export function filterOf(wanted: Wanted): JobFilter {
  const verdict = verdictOf(wanted.verdict);
  const text = wanted.text.trim().slice(0, kLongestText);
  return {
    ...(wanted.part ? { part_id: wanted.part.slice(0, kLongestText) } : {}),
    ...(wanted.recipe ? { recipe: wanted.recipe.slice(0, kLongestText) } : {}),
    ...(verdict ? { verdict } : {}),
    ...(isDay(wanted.from) ? { from_utc: `${wanted.from}T00:00:00.000Z` } : {}),
    ...(isDay(wanted.to) ? { to_utc: `${wanted.to}T23:59:59.999Z` } : {}),
    ...(text ? { text } : {}),
  };
}
