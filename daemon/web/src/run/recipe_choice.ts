// Which recipe a start would name. Drafts that were kept to be tried are never what nobody chose: a trial scan prepares its
// draft, and the next part would be measured by that.
import { isTryId } from "../recipe/ids.ts";

export interface Candidates {
  choice: string | null;              // of the person at this tab
  prepared?: string | undefined;      // in the daemon
  measured: readonly string[];        // those of the last jobs, the newest first
  known: readonly string[] | null;    // null = not told yet
}

// Empty: there is none but drafts.
export function recipeToStart({ choice, prepared, measured, known }: Candidates): string {
  const isThere = (id: string): boolean => known === null || known.includes(id);
  if (choice && isThere(choice)) return choice;
  const wanted = [prepared ?? "", ...measured].filter((id) => id !== "" && !isTryId(id));
  return wanted.find(isThere) ?? known?.find((id) => !isTryId(id)) ?? "";
}

// Drafts stand last.
export const offered = (known: readonly string[]): string[] =>
  [...known.filter((id) => !isTryId(id)), ...known.filter((id) => isTryId(id))];
