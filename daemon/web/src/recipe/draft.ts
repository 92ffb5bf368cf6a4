// Changes that were not saved yet, kept in this tab so that another page (a profile that becomes a measurement) or a reload does not lose them.
export interface Draft {
  text: string;
  base_version: number;  // the version that the change was made from
}

const keyOf = (id: string): string => `fvd.draft.${id}`;

export function readDraft(id: string): Draft | null {
  try {
    const value = JSON.parse(sessionStorage.getItem(keyOf(id)) ?? "null") as Draft | null;
    return value && typeof value.text === "string" && Number.isInteger(value.base_version) ? value : null;
  } catch {
    return null;
  }
}

export const keepDraft = (id: string, draft: Draft): void => sessionStorage.setItem(keyOf(id), JSON.stringify(draft));

export const dropDraft = (id: string): void => sessionStorage.removeItem(keyOf(id));
