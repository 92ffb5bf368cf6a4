// What the one button is, and why it may not be pressed.
export type ButtonAction = "start" | "stop" | "reset";
export type Why =
  | "link" | "no_role" | "control" | "part_empty" | "part_long" | "part_characters" | "recipe"
  | "preoperational" | "halted" | "not_ready" | "unknown";

export interface Situation {
  isLinked: boolean;
  state: { state: string; ready: boolean } | null;
  mayOperate: boolean;
  mayTryStop: boolean;
  hasAnotherControl: boolean;
  partProblem: "none" | "empty" | "long" | "characters";
  hasRecipe: boolean;
}

export interface OneButton {
  action: ButtonAction;
  why: Why | null;  // null = it may be pressed
}

export function oneButton(at: Situation): OneButton {
  const { state } = at;
  if (state?.state === "executing") {
    // A stop is tried even where nobody seems to listen.
    return { action: "stop", why: at.mayTryStop ? null : "no_role" };
  }
  const action: ButtonAction = state?.state === "error" ? "reset" : "start";
  return { action, why: whyNot(at, action) };
}

function whyNot(at: Situation, action: ButtonAction): Why | null {
  if (!at.isLinked) return "link";
  if (!at.state) return "unknown";
  if (!at.mayOperate) return "no_role";
  if (action === "reset") return null;
  if (at.state.state === "preoperational" || at.state.state === "halted") return at.state.state;
  if (at.hasAnotherControl) return "control";
  if (!at.hasRecipe) return "recipe";
  if (at.partProblem !== "none") return `part_${at.partProblem}`;
  return at.state.ready ? null : "not_ready";
}

export interface Press {
  action: ButtonAction;
  at_ms: number;
}

// One button with three meanings: the second click of a double click must not mean something else than the first.
export function isSlip(last: Press | null, action: ButtonAction, now_ms: number): boolean {
  if (!last || last.action === action) return false;
  const since_ms = now_ms - last.at_ms;
  return since_ms < (action === "stop" ? 400 : 1200);
}
