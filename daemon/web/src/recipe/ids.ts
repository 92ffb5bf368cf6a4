// Ids of recipes: 1 to 32 letters, digits, "_" and "-".
const kLongest = 32;

export const isId = (text: string): boolean => /^[A-Za-z0-9_-]{1,32}$/.test(text);

// The nearest id to a text, e.g. to a file's name.
export const idFrom = (text: string): string => text.replace(/\.json$/i, "").replace(/[^A-Za-z0-9_-]+/g, "_").slice(0, kLongest) || "recipe";

export function freeId(wanted: string, taken: readonly string[]): string {
  if (!taken.includes(wanted)) return wanted;
  for (let i = 2; ; ++i) {
    const end = `_${i}`;
    const id = wanted.slice(0, kLongest - end.length) + end;
    if (!taken.includes(id)) return id;
  }
}

// Under which a recipe's draft is kept while it is tried.
export const tryId = (id: string): string => `try_${id}`.slice(0, kLongest);

export const isTryId = (id: string): boolean => id.startsWith("try_");
