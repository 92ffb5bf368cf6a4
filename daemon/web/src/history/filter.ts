// What of the history is asked for, as it stands in the page's address.
import type { JobFilter, JobRow } from "../rpc/to_come_history.ts";

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

// What the database seeks. The text is not among it: it is sought in the rows that are shown.
export function filterOf(wanted: Wanted): JobFilter {
  return {
    ...(wanted.part ? { part_id: wanted.part } : {}),
    ...(wanted.recipe ? { recipe: wanted.recipe } : {}),
    ...(wanted.verdict ? { verdict: wanted.verdict } : {}),
    ...(isDay(wanted.from) ? { from_utc: `${wanted.from}T00:00:00.000Z` } : {}),
    ...(isDay(wanted.to) ? { to_utc: `${wanted.to}T23:59:59.999Z` } : {}),
  };
}

export function hasText(row: JobRow, text: string): boolean {
  const sought = text.trim().toLowerCase();
  return sought === "" || [row.job_id, row.part_id, row.recipe, row.client, row.error, row.state].some((each) => each.toLowerCase().includes(sought));
}

// The same that the database does, for rows that came without it.
export function fits(row: JobRow, wanted: Wanted): boolean {
  const filter = filterOf(wanted);
  return (!filter.part_id || row.part_id.startsWith(filter.part_id))
    && (!filter.recipe || row.recipe === filter.recipe)
    && (!filter.verdict || row.verdict === filter.verdict)
    && (!filter.from_utc || row.ended_utc >= filter.from_utc)
    && (!filter.to_utc || row.ended_utc <= filter.to_utc)
    && hasText(row, wanted.text);
}
