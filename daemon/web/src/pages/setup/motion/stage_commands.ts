// One motion a press: to a place, to the reference, to where the picture is sharpest.
import { useState } from "preact/hooks";
import { asCommand } from "../../../camera/devices_turn.ts";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { readNumber } from "../../../lib/read_number.ts";
import { call } from "../../../rpc/rpc.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { sawStageAt, stagePlace } from "./stage_place.ts";

export function StageCommands() {
  useLanguage();
  const [target, setTarget] = useState("");
  const { running, answer, problem, run } = useCommand<{ z_um: number }>();
  const why = useRefusal({ role: "set_up", control: true, still: true });
  const whyHome = useRefusal({ role: "operate", control: true, still: true });
  const z_um = readNumber(target);

  const moved = (work: () => Promise<{ z_um: number }>): void => {
    void run(() => asCommand(async () => {
      stagePlace.set(null);
      const reached = await work();
      sawStageAt(reached.z_um);
      return reached;
    }));
  };
  return html`<section class="panel" aria-labelledby="move-title">
    <h2 id="move-title">${t("setup.move.title")}</h2>
    <form onSubmit=${(event: Event) => {
      event.preventDefault();
      if (z_um !== null && why === "" && !running) moved(() => call("stage.move", { z_um }));
    }}>
      <label class="field">${t("setup.move.target")}
        <input class="short" inputmode="text" value=${target} onInput=${(event: Event) => setTarget((event.target as HTMLInputElement).value)}/>
      </label>
      <p class="buttons">
        <button type="submit" disabled=${why !== "" || z_um === null || running}>${t("setup.move.go")}</button>
        <button type="button" disabled=${whyHome !== "" || running} onClick=${() => moved(() => call("stage.home", {}))}>${t("setup.move.home")}</button>
      </p>
    </form>
    <p class="help" aria-live="polite">${running ? t("setup.running") : why || (answer && t("setup.move.reached", { z: number(answer.z_um, 2) })) || t("setup.move.help")}</p>
    <${Problem} text=${problem}/>
  </section>`;
}
