// Who may move the station, who this tab is, and STOP, on every part of the set-up page.
import { useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { giveControlBack, isHeldHere, takeControl } from "../../rpc/held_control.ts";
import { mayTryStop } from "../../rpc/session.ts";
import { stopStage } from "../../rpc/stop_stage.ts";
import { isMine } from "./access_rules.ts";
import { useRefusal, useSeen } from "./permission.ts";
import { Problem } from "./problem.ts";
import { useCommand } from "./use_command.ts";

export function ControlStrip() {
  useLanguage();
  const seen = useSeen();
  const keeps = useStore(isHeldHere);
  const change = useCommand<void>();
  const [stopProblem, setStopProblem] = useState("");
  const why = useRefusal({ role: "operate" });
  const whyForce = useRefusal({ role: "administer" });
  const mine = isMine(seen);
  const owner = seen.control?.owner ?? "";
  const others = owner !== "" && !mine;

  // Each press is sent, also where nobody seems to listen: streams of events may be refused, or broken, where calls are answered.
  const stop = (): void => {
    setStopProblem("");
    stopStage().catch((error: unknown) => setStopProblem(messageOf(error)));
  };
  const state = mine ? t(keeps ? "setup.control.mine" : "setup.control.mine_elsewhere")
    : others ? t("setup.control.other", { owner, who: seen.control?.who ?? "" })
      : t("setup.control.nobody");
  const me = seen.hasToken ? t("session.as", { who: seen.who, role: tWord("role", seen.role) }) : t("session.none");
  return html`<section class="panel control-strip" aria-label=${t("setup.control.title")}>
    <div>
      <p aria-live="polite"><span aria-hidden="true">${mine ? "●" : others ? "▲" : "○"}</span> ${state}</p>
      <p class="help">${me}</p>
    </div>
    <p class="buttons">
      ${mine && keeps
        ? html`<button type="button" disabled=${why !== "" || change.running} onClick=${() => void change.run(giveControlBack)}>${t("setup.control.release")}</button>`
        : others
          ? html`<button type="button" disabled=${whyForce !== "" || change.running} onClick=${() => void change.run(() => takeControl(true))}>${t("setup.control.force")}</button>`
          : html`<button type="button" disabled=${why !== "" || change.running} onClick=${() => void change.run(() => takeControl(false))}>${t("setup.control.take")}</button>`}
      <button type="button" class="main stop" disabled=${!mayTryStop(seen.role)} onClick=${stop}>${t("setup.stop")}</button>
    </p>
    ${(why || (others && whyForce)) && html`<p class="help wide">${why || whyForce}</p>`}
    <p class="help wide">${t("setup.stop_is_no_safety")}</p>
    <${Problem} text=${change.problem || stopProblem}/>
  </section>`;
}
