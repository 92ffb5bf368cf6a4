// START, STOP or RESET: one place for the hand, whatever the machine is doing.
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { type ButtonAction, type Press, isSlip } from "../../run/button_rules.ts";
import { reset, start, stop } from "./commands.ts";
import { awaited, notice, partId, recipeChoice, recipes } from "./run_state.ts";
import { buttonNow, recipeOf, useButton } from "./use_machine.ts";

const kIcons: Record<ButtonAction, string> = {
  start: "M7 3v18l14-9Z",
  stop: "M4 4h16v16H4Z",
  reset: "M12 4a8 8 0 1 1-7.7 10h3.2a5 5 0 1 0 .6-4L11 13H2V4l3.300 3.300A8 8 0 0 1 12 4Z",
};

let last: Press | null = null;

// By the button, or by F9 (which only starts).
export function press(): void {
  const { action, why } = buttonNow();
  const now_ms = performance.now();
  if (isSlip(last, action, now_ms)) return;
  last = { action, at_ms: now_ms };
  if (why !== null) {
    notice.set({ kind: "problem", text: whyText(why) });
    return;
  }
  if (action === "stop") void stop();
  else if (action === "reset") void reset();
  else void start(partId.get(), recipeOf(recipeChoice.get(), recipes.get()));
}

export function whyText(why: string): string {
  const { control } = topics.get();
  return why === "control"
    ? t("run.why.control", { owner: control?.owner ?? "", who: control?.who ?? "" })
    : tWord("run.why", why);
}

export function OneButton() {
  useLanguage();
  const { action, why } = useButton();
  const waits = useStore(awaited) === action;
  return html`<div class="one-button">
    <button type="button" class=${`main one one-${action}`} aria-disabled=${why !== null} aria-busy=${waits}
        aria-describedby="one-button-why" aria-keyshortcuts=${action === "start" ? "F9" : action === "stop" ? "F10" : undefined}
        onClick=${press}>
      <svg width="32" height="32" viewBox="0 0 24 24" fill="currentColor" aria-hidden="true"><path d=${kIcons[action]}/></svg>
      <span>${tWord("run.button", action)}</span>
      ${action !== "reset" && html`<kbd>${action === "start" ? "F9" : "F10"}</kbd>`}
    </button>
    <p id="one-button-why" class="help">${why === null ? tWord("run.button_help", action) : whyText(why)}</p>
  </div>`;
}
