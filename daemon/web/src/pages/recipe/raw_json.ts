// The document as text. What is typed here is in the form at once, as soon as it is JSON.
import { useEffect, useRef } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { formatJson } from "../../recipe/format_json.ts";
import { offsetOf, placeOf } from "../../recipe/problems.ts";
import type { Editor } from "./editor.ts";

export function RawJson({ editor, place }: { editor: Editor; place: { pointer: string; count: number } }) {
  const area = useRef<HTMLTextAreaElement>(null);
  useEffect(() => {
    if (place.count === 0 || !area.current) return;
    const written = /^line:(\d+):(\d+)$/.exec(place.pointer);
    const at = written ? offsetOf(editor.text, Number(written[1]), Number(written[2])) : placeOf(editor.text, place.pointer);
    if (at < 0) return;
    const end = editor.text.indexOf("\n", at);
    area.current.focus();
    area.current.setSelectionRange(at, end < 0 ? editor.text.length : end);
  }, [place]);
  const { document } = editor;
  return html`<label for="recipe-text">${t("recipe.text_label")}</label>
    <textarea id="recipe-text" class="raw" ref=${area} spellcheck=${false} wrap="off" rows="30" value=${editor.text}
      onInput=${(event: Event) => editor.setText((event.target as HTMLTextAreaElement).value)}></textarea>
    <p class="buttons"><button type="button" disabled=${document === null} onClick=${() => document !== null && editor.setText(formatJson(document))}>${t("recipe.tidy")}</button></p>`;
}
