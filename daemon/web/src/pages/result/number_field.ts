// A number that people type, with either decimal sign; taken over when it is one.
import { useEffect, useState } from "preact/hooks";
import { number } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { readNumber } from "../../lib/read_number.ts";

interface Props {
  label: string;
  value: number;
  digits: number;
  unit?: string;
  least?: number;
  most?: number;
  disabled?: boolean;
  onChange: (value: number) => void;
}

export function NumberField({ label, value, digits, unit = "", least = -Infinity, most = Infinity, disabled = false, onChange }: Props) {
  const shown = number(value, digits);
  const [text, setText] = useState(shown);
  const [isWrong, setWrong] = useState(false);
  useEffect(() => {
    setText(shown);
    setWrong(false);
  }, [shown]);
  const take = (event: Event): void => {
    const typed = (event.target as HTMLInputElement).value;
    setText(typed);
    const read = readNumber(typed);
    const bad = read === null || read < least || read > most;
    setWrong(bad);
    if (!bad && number(read, digits) !== shown) onChange(read);
  };
  return html`<label class="number-field"><span>${label}${unit && ` (${unit})`}</span>
    <input type="text" inputmode="decimal" size="7" value=${text} disabled=${disabled} aria-invalid=${isWrong ? "true" : undefined}
      onInput=${(event: Event) => setText((event.target as HTMLInputElement).value)} onChange=${take}
      onKeyDown=${(event: KeyboardEvent) => {
        if (event.key === "Enter") take(event);
      }}/>
  </label>`;
}
