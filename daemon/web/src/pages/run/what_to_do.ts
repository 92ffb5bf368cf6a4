// What an operator can do about an error of the daemon, by its code; empty where its message has to say it all.
import { tWord } from "../../i18n/i18n.ts";

export function whatToDo(code: number): string {
  const key = String(code);
  const text = code === 0 ? "" : tWord("run.todo", key);
  return text === key ? "" : text;
}
