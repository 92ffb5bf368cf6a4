// Who has control: take it, give it back, or read why one has it not.
import { useEffect, useRef, useState } from "preact/hooks";
import { number, t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { giveControlBack, isHeldHere, renewalFault, takeControl } from "../../rpc/held_control.ts";
import { mayAs, session } from "../../rpc/session.ts";

// The seconds that the daemon told, less those since: never by this browser's clock.
function useRemaining(remaining_s: number | undefined, key: string): number {
  const [told, setTold] = useState({ remaining_s: 0, at_ms: 0 });
  const [, tick] = useState(0);
  useEffect(() => {
    setTold({ remaining_s: remaining_s ?? 0, at_ms: performance.now() });
    if (!remaining_s) return;
    const timer = setInterval(() => tick((count) => count + 1), 1000);
    return () => clearInterval(timer);
  }, [remaining_s, key]);
  return Math.max(0, told.remaining_s - (performance.now() - told.at_ms) / 1000);
}

export function ControlPanel() {
  useLanguage();
  const { control, job } = useStore(topics);
  const { who, role } = useStore(session);
  const isLinked = useStore(link).status === "open";
  const [problem, setProblem] = useState("");
  const dialog = useRef<HTMLDialogElement>(null);
  const isTaken = control !== null && control.owner !== "";
  const isOurs = isTaken && control.who === who;
  const left_s = useRemaining(control?.remaining_s, `${control?.owner} ${control?.who}`);
  const isHere = useStore(isHeldHere);
  const fault = useStore(renewalFault);

  const run = (work: Promise<unknown>): void => {
    setProblem("");
    work.catch((error: unknown) => setProblem(messageOf(error)));
  };
  const take = (force: boolean): void => {
    dialog.current?.close();
    run(takeControl(force));
  };

  const runs = job !== null && !job.done;
  const why = !isLinked ? "run.why.link" as const
    : !mayAs(role, "operate") ? "run.why.no_role" as const
    : isTaken && !isOurs && !mayAs(role, "administer") ? "run.control_why_other" as const
    : isTaken && !isOurs && runs ? "run.control_why_job" as const : null;
  const names = { owner: control?.owner ?? "", who: control?.who ?? "" };
  return html`<section class="panel control" aria-labelledby="control-title">
    <h2 id="control-title">${t("run.control")}</h2>
    <p role="status">${!isTaken ? t("run.control_nobody") : t(isOurs ? "run.control_yours" : "run.control_other", names)}</p>
    ${isTaken && html`<p class="help">${isOurs && isHere ? t("run.control_kept") : t("run.control_left", { seconds: number(Math.ceil(left_s), 0) })}</p>`}
    <p class="buttons">
      ${isOurs
        ? html`<button type="button" onClick=${() => run(giveControlBack())}>${t("run.control_release")}</button>`
        : html`<button type="button" disabled=${why !== null} aria-describedby="control-why"
            onClick=${() => (isTaken ? dialog.current?.showModal() : take(false))}>${t(isTaken ? "run.control_force" : "run.control_take")}</button>`}
    </p>
    <p id="control-why" class="help">${why !== null ? t(why, names) : isOurs && !isHere ? t("run.control_elsewhere") : t("run.control_help")}</p>
    ${(problem || fault !== null) && html`<p class="problem" role="alert">${problem || messageOf(fault)}</p>`}
    <dialog ref=${dialog} aria-labelledby="force-title">
      <h2 id="force-title">${t("run.control_force")}</h2>
      <p>${t("run.control_force_says", names)}</p>
      <p class="buttons">
        <button type="button" class="main" onClick=${() => take(true)}>${t("run.control_force")}</button>
        <button type="button" onClick=${() => dialog.current?.close()}>${t("cancel")}</button>
      </p>
    </dialog>
  </section>`;
}
