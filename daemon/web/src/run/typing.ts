// Where keys go. What is typed belongs to the field that it is typed into.
const kNoText = ["checkbox", "radio", "button", "submit", "reset", "range", "color", "file", "image"];

export interface Focused {
  localName: string;
  type?: string;
  isContentEditable?: boolean;
}

export const takesText = (at: Focused | null): boolean => at !== null && (at.isContentEditable === true || at.localName === "textarea" ||
  at.localName === "input" && !kNoText.includes(at.type ?? "text"));

// A list takes letters too: they choose in it.
export const takesKeys = (at: Focused | null): boolean => takesText(at) || at?.localName === "select";
