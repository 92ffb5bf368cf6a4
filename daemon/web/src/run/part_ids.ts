// Part ids as the daemon takes them: 1 to 64 printable ASCII characters.
export const kMostPartId = 64;

export type PartIdProblem = "none" | "empty" | "long" | "characters";

export function partIdProblem(id: string): PartIdProblem {
  if (id.length === 0) return "empty";
  if (!/^[\x20-\x7e]*$/.test(id)) return "characters";
  return id.length > kMostPartId ? "long" : "none";
}

// The id that counts on: the last run of digits one higher, as wide as it was; "part-0001" where nothing was before.
export function nextPartId(id: string): string {
  if (partIdProblem(id) !== "none") return "part-0001";
  const found = /^(.*?)(\d+)(\D*)$/.exec(id);
  if (!found) return cut(`${id}-2`);
  const [, before = "", digits = "", after = ""] = found;
  // Digits may be more than a number holds.
  const next = (BigInt(digits) + 1n).toString().padStart(digits.length, "0");
  return cut(before + next + after);
}

// Keeps the end, in which the number is.
const cut = (id: string): string => id.slice(-kMostPartId);
