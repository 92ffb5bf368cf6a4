// Looks for the sharpest place in a range, and shows how sharp it was where.
import { useState } from "preact/hooks";
import { asCommand } from "../../../camera/devices_turn.ts";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { readNumber } from "../../../lib/read_number.ts";
import { useStore } from "../../../lib/store.ts";
import { call } from "../../../rpc/rpc.ts";
import { LinePlot } from "../line_plot.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { isLight, light, lightParams } from "./light.ts";
import { sawStageAt, stagePlace } from "./stage_place.ts";

type Found = Awaited<ReturnType<typeof call<"stage.autofocus">>>;

export function AutofocusForm() {
  useLanguage();
  const [range, setRange] = useState({ from: "", to: "", step: "" });
  const settings = useStore(light);
  const { running, answer, problem, run } = useCommand<Found>();
  const why = useRefusal({ role: "set_up", control: true, still: true });
  const from_um = readNumber(range.from);
  const to_um = readNumber(range.to);
  const step_um = readNumber(range.step);
  const isRange = from_um !== null && to_um !== null && from_um < to_um && (range.step.trim() === "" || (step_um !== null && step_um > 0));

  const search = (event: Event): void => {
    event.preventDefault();
    if (!isRange || why !== "" || running) return;
    void run(() => asCommand(async () => {
      stagePlace.set(null);
      const found = await call("stage.autofocus", { ...lightParams(settings), from_um, to_um, ...(step_um === null ? {} : { step_um }) });
      sawStageAt(found.z_um);
      return found;
    }));
  };
  const field = (name: keyof typeof range, label: string) => html`<label class="field">${label}
    <input class="short" value=${range[name]} onInput=${(event: Event) => setRange({ ...range, [name]: (event.target as HTMLInputElement).value })}/>
  </label>`;
  const curve = (answer?.curve_um_focus ?? []) as [number, number][];
  return html`<section class="panel" aria-labelledby="focus-title">
    <h2 id="focus-title">${t("setup.focus.title")}</h2>
    <form onSubmit=${search}>
      <div class="fields">
        ${field("from", t("setup.focus.from"))} ${field("to", t("setup.focus.to"))} ${field("step", t("setup.focus.step"))}
      </div>
      <p class="buttons"><button type="submit" disabled=${why !== "" || !isRange || !isLight(settings) || running}>${t("setup.focus.go")}</button></p>
    </form>
    <p class="help" aria-live="polite">${running ? t("setup.running") : why || (answer && t("setup.focus.found", { z: number(answer.z_um, 2), focus: number(answer.focus, 2) })) || t("setup.focus.help")}</p>
    <${Problem} text=${problem}/>
    ${curve.length > 1 && html`<${LinePlot} points=${curve} mark=${answer?.z_um} x=${t("setup.focus.x")} y=${t("setup.focus.y")}/>`}
  </section>`;
}
