// What the person at this tab has chosen and was told: kept while other pages are looked at.
import { createStore } from "../../lib/store.ts";
import type { ButtonAction } from "../../run/button_rules.ts";

export const partId = createStore("");
export const recipeChoice = createStore<string | null>(null);  // null = nobody chose: the prepared one, or the last
export const recipes = createStore<readonly string[] | null>(null);  // null = not told yet
export const recentRecipes = createStore<readonly string[]>([]);  // of the last parts, the newest first

const kCountsOn = "fvd.run.counts_on";
export const countsOn = createStore(localStorage.getItem(kCountsOn) === "yes");
export function setCountsOn(wanted: boolean): void {
  localStorage.setItem(kCountsOn, wanted ? "yes" : "no");
  countsOn.set(wanted);
}

// The command whose answer is awaited.
export const awaited = createStore<ButtonAction | "home" | null>(null);

// The last reset told of a stage without its reference, and nobody has found it since.
export const lacksReference = createStore(false);

export interface Notice {
  kind: "problem" | "note";
  text: string;
}
export const notice = createStore<Notice | null>(null);
