// What the daemon's checker says of a document, one problem a line: "recipe ID: /acquire/scan/step_um: -1 is not accepted; …".
import { pathOf, pointerOf } from "./document.ts";

export interface Problem {
  pointer: string | null;  // null = of the whole document
  text: string;
  line?: number;           // of a text that is no JSON
  column?: number;
}

// The path of a problem ends where ": " begins; names may contain blanks, never a colon followed by one unless the name does, and then the text is a little longer.
export function problemsOf(refusal: unknown): Problem[] {
  if (typeof refusal !== "string") return [];
  return refusal.split("\n").filter((line) => line !== "").map((line) => {
    const said = line.replace(/^recipe [A-Za-z0-9_-]*: /, "");
    const place = /^(\/.*?): (.*)$/s.exec(said);
    if (place) return { pointer: place[1] ?? "", text: place[2] ?? "" };
    const written = /at line (\d+), column (\d+)/.exec(said);
    return written ? { pointer: null, text: said, line: Number(written[1]), column: Number(written[2]) } : { pointer: null, text: said };
  });
}

// Of a field: what is said of it. Of what has no field of its own (an unknown key, a missing object) its nearest ancestor that has one tells.
export function problemsAt(problems: readonly Problem[], pointer: string): Problem[] {
  return problems.filter((problem) => problem.pointer === pointer);
}

export function problemsUnder(problems: readonly Problem[], pointer: string): Problem[] {
  return problems.filter((problem) => problem.pointer !== null && (problem.pointer === pointer || problem.pointer.startsWith(`${pointer}/`)));
}

// The pointers above this one, from itself to the top.
export function ancestors(pointer: string): string[] {
  const path = pathOf(pointer);
  return path.map((_, i) => pointerOf(path.slice(0, path.length - i)));
}

// Where line and column (from 1) lie in a text.
export function offsetOf(text: string, line: number, column: number): number {
  const lines = text.split("\n");
  const before = lines.slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
  return Math.min(text.length, before + Math.max(0, column - 1));
}

// Where the value of a pointer begins in a text that is valid JSON; -1 where it is not there.
export function placeOf(text: string, pointer: string): number {
  const wanted = pathOf(pointer);
  let at = 0;
  const blank = (): void => { while (/\s/.test(text[at] ?? "")) ++at; };
  const string = (): string => {
    const begin = at++;
    while (at < text.length && text[at] !== '"') at += text[at] === "\\" ? 2 : 1;
    ++at;
    try {
      return JSON.parse(text.slice(begin, at)) as string;
    } catch {
      return "";
    }
  };
  // Goes over a value; tells where the wanted one begins if it is in it.
  const value = (depth: number, on: boolean): number => {
    blank();
    if (on && depth === wanted.length) return at;
    const open = text[at];
    if (open === "{" || open === "[") {
      ++at;
      for (let i = 0; at < text.length; ++i) {
        blank();
        if (text[at] === "}" || text[at] === "]") break;
        const begin = at;
        const key = open === "{" ? string() : String(i);
        if (open === "{") {
          blank();
          ++at;  // the colon
        }
        const is = on && wanted[depth] === key;
        const found = value(depth + 1, is);
        if (found >= 0) return open === "{" && depth + 1 === wanted.length ? begin : found;
        blank();
        if (text[at] === ",") ++at;
      }
      ++at;
      return -1;
    }
    if (open === '"') string();
    else while (at < text.length && !/[\s,\]}]/.test(text[at] ?? "")) ++at;
    return -1;
  };
  return value(0, true);
}
