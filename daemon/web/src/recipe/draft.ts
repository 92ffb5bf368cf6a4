// Changes that were not saved yet, kept in this tab so that another page (a profile that becomes a measurement) or a reload does not lose them.
export interface Draft {
  text: string;
  base_version: number;  // the version that the change was made from
  step?: number;         // of the assistant, where it was left
}

const keyOf = (id: string): string => `fvd.draft.${id}`;

export function readDraft(id: string): Draft | null {
  try {
    const value = JSON.parse(sessionStorage.getItem(keyOf(id)) ?? "null") as Draft | null;
    if (!value || typeof value.text !== "string" || !Number.isInteger(value.base_version)) return null;
    return { text: value.text, base_version: value.base_version, ...(Number.isInteger(value.step) ? { step: value.step } : {}) } as Draft;
  } catch {
    return null;
  }
}

export const keepDraft = (id: string, draft: Draft): void => sessionStorage.setItem(keyOf(id), JSON.stringify(draft));

export const dropDraft = (id: string): void => sessionStorage.removeItem(keyOf(id));
