// The document that form, text and map edit together, and what the daemon's checker says of it.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { askNewest } from "../../lib/newest.ts";
import { messageOf } from "../../parts/message_of.ts";
import { type Path, getAt, removeAt, setAt } from "../../recipe/document.ts";
import { formatJson } from "../../recipe/format_json.ts";
import { type Problem, problemsOf } from "../../recipe/problems.ts";
import { renameWithUses } from "../../recipe/rename.ts";
import { type Json, type JsonObject, isObject } from "../../recipe/schema.ts";
import { call } from "../../rpc/rpc.ts";

const kPause_ms = 200;  // of typing, before the daemon is asked

export interface Check {
  text: string;  // that was checked: the answer counts for no other
  accepted: boolean;
  problems: Problem[];
  notes: string[];
  failed: string;  // why there is no answer
}

export interface Editor {
  id: string;
  text: string;
  document: JsonObject | null;  // null while the text is no JSON object
  check: Check | null;
  isChecked: boolean;           // the check is of this very text
  problems: readonly Problem[];
  setText(text: string): void;
  set(path: Path, value: Json): void;
  remove(path: Path): void;
  rename(path: Path, name: string): void;
}

function parse(text: string): JsonObject | null {
  try {
    const value: unknown = JSON.parse(text);
    return isObject(value) ? value : null;
  } catch {
    return null;
  }
}

export function useEditor(id: string, initial: string): Editor {
  const [text, setText] = useState(initial);
  const [check, setCheck] = useState<Check | null>(null);
  const document = useMemo(() => parse(text), [text]);
  // The newest text, for two changes between two drawings.
  const now = useRef(text);
  now.current = text;

  const asker = useMemo(() => askNewest(
    (asked: string, signal) => call("recipe.check", { text: asked, id: id || "new" }, { signal }),
    (answer, asked) => setCheck({
      text: asked,
      accepted: answer.accepted,
      problems: problemsOf(answer.refusal),
      notes: Array.isArray(answer.notes) ? answer.notes.map(String) : [],
      failed: "",
    }),
    (error, asked) => setCheck({ text: asked, accepted: false, problems: [], notes: [], failed: messageOf(error) }),
    kPause_ms,
  ), [id]);
  useEffect(() => {
    asker.ask(text);
    return asker.end;
  }, [asker, text]);

  const change = (by: (document: Json) => Json): void => {
    const before = parse(now.current);
    if (before === null) return;
    now.current = formatJson(by(before));
    setText(now.current);
  };
  return {
    id,
    text,
    document,
    check,
    isChecked: check?.text === text,
    problems: check?.problems ?? [],
    setText,
    set: (path, value) => change((before) => setAt(before, path, value)),
    remove: (path) => change((before) => removeAt(before, path)),
    rename: (path, name) => change((before) => renameWithUses(before, path, name)),
  };
}

// The names below evaluation/regions or evaluation/surfaces, for fields that name one.
export function namesOf(editor: Editor, section: "regions" | "surfaces"): string[] {
  const holder = getAt(editor.document ?? undefined, ["evaluation", section]);
  return isObject(holder) ? Object.keys(holder) : [];
}
