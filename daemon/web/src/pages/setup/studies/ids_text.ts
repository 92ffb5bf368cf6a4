// Job ids in a text, one a line: typed, pasted from a table, or put there by ticks.

export const idsIn = (text: string): string[] => [...new Set(text.split(/[\s,;]+/).filter(Boolean))];

// The order of ids matters to studies with operators: what is added comes last.
export function withId(ids: readonly string[], id: string, wanted: boolean): string[] {
  const others = ids.filter((each) => each !== id);
  return wanted ? (ids.includes(id) ? [...ids] : [...others, id]) : others;
}
