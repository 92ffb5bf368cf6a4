// Keys that work wherever the focus is: F9 starts, F10 stops; a scanner's code becomes the part id.
import { useEffect } from "preact/hooks";
import { kNoScan, takeKey } from "../../run/scanner.ts";
import { type Focused, takesKeys, takesText } from "../../run/typing.ts";
import { stop } from "./commands.ts";
import { press } from "./one_button.ts";
import { awaited, partId } from "./run_state.ts";
import { buttonNow } from "./use_machine.ts";

// All of this page's dialogs are modal; not every browser knows "dialog:modal".
const isModalOpen = (): boolean => document.querySelector("dialog[open]") !== null;

// Gives the field the focus, unless a dialog or what can be typed into has it. A scanner may be slower than what is told from
// a person's typing, and its code would be lost.
export function focusIfFree(field: HTMLElement | null): void {
  if (!isModalOpen() && !takesKeys(document.activeElement as Focused | null)) field?.focus({ preventScroll: true });
}

export function useKeys(scanned: (code: string) => void): void {
  useEffect(() => {
    let scan = kNoScan;
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "F10") {
        // A stop is never in the way, also while a dialog is open.
        event.preventDefault();
        if (!event.repeat) void stop();
        return;
      }
      if (event.key === "F9") {
        event.preventDefault();
        if (!event.repeat && !isModalOpen() && awaited.get() !== "start" && buttonNow().action === "start") press();
        return;
      }
      if (isModalOpen() || event.target instanceof HTMLElement && takesText(event.target) || event.ctrlKey || event.metaKey || event.altKey) {
        scan = kNoScan;
        return;
      }
      const step = takeKey(scan, event.key, event.timeStamp);
      scan = step.next;
      // Enter and blanks of a code must not press the button that has the focus.
      if (step.isBurst) event.preventDefault();
      if (step.scanned !== null) {
        partId.set(step.scanned);
        scanned(step.scanned);
      }
    };
    document.addEventListener("keydown", onKey, { capture: true });
    return () => document.removeEventListener("keydown", onKey, { capture: true });
  }, [scanned]);
}
