// Light: what pictures are taken with, what the daemon suggests, and one picture kept on the instrument's computer.
import { useEffect, useState } from "preact/hooks";
import { asCommand } from "../../../camera/devices_turn.ts";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { usefulDigits } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { call } from "../../../rpc/rpc.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { type Light, isLight, light, lightParams } from "./light.ts";
import { sawStageAt } from "./stage_place.ts";

type Suggested = Awaited<ReturnType<typeof call<"camera.suggest_exposure">>>;
type Snapped = Awaited<ReturnType<typeof call<"camera.snap">>>;

// Grey levels as the daemon counts them, those that tell whether the light is right.
const kShown = ["min", "p01", "p50", "p99", "p999", "max"];

function Grey({ grey }: { grey: unknown }) {
  const levels = (grey ?? {}) as Record<string, number>;
  return html`<table><caption class="hidden">${t("setup.camera.grey")}</caption>
    <tr>${kShown.map((name) => html`<th scope="col" class="number">${name}</th>`)}<th scope="col" class="number">${t("setup.camera.saturated")}</th></tr>
    <tr>${kShown.map((name) => html`<td class="number">${number(levels[name] ?? NaN, 0)}</td>`)}
      <td class="number">${number(100 * (levels["saturated_fraction"] ?? NaN), 2)} %</td></tr>
  </table>`;
}

function useRecipes(): string[] {
  const [recipes, setRecipes] = useState<string[]>([]);
  useEffect(() => {
    let gone = false;
    call("recipe.list", {}).then((told) => gone || setRecipes(told.recipes as string[]), () => undefined);  // then none can be chosen
    return () => void (gone = true);
  }, []);
  return recipes;
}

export function CameraCommands() {
  useLanguage();
  const settings = useStore(light);
  const recipes = useRecipes();
  const suggestion = useCommand<Suggested>();
  const snap = useCommand<Snapped>();
  const why = useRefusal({ role: "set_up", still: true });
  const change = (name: keyof Light) => (event: Event): void =>
    light.update((now) => ({ ...now, [name]: (event.target as HTMLInputElement).value }));
  const mayNot = why !== "" || !isLight(settings) || suggestion.running || snap.running;

  const suggest = (): void => void suggestion.run(() => asCommand(async () => {
    const found = await call("camera.suggest_exposure", lightParams(settings));
    const { exposure_us } = found;
    light.update((now) => ({ ...now, exposure_us: number(exposure_us, usefulDigits(exposure_us)) }));
    return found;
  }));
  const take = (): void => void snap.run(() => asCommand(async () => {
    const taken = await call("camera.snap", lightParams(settings));
    sawStageAt(taken.z_um);
    return taken;
  }));
  return html`<section class="panel" aria-labelledby="camera-title">
    <h2 id="camera-title">${t("setup.camera.title")}</h2>
    <div class="fields">
      <label class="field">${t("setup.camera.exposure")} <input class="short" inputmode="decimal" value=${settings.exposure_us} onInput=${change("exposure_us")}/></label>
      <label class="field">${t("setup.camera.gain")} <input class="short" inputmode="decimal" value=${settings.gain_db} onInput=${change("gain_db")}/></label>
      <label class="field">${t("setup.camera.recipe")}
        <select value=${settings.recipe} onChange=${change("recipe")}>
          <option value="">${t("setup.camera.no_recipe")}</option>
          ${recipes.map((id) => html`<option key=${id} value=${id}>${id}</option>`)}
        </select>
      </label>
    </div>
    ${!isLight(settings) && html`<${Problem} text=${t("setup.no_number")}/>`}
    <p class="buttons">
      <button type="button" disabled=${mayNot} onClick=${suggest}>${t("setup.camera.suggest")}</button>
      <button type="button" disabled=${mayNot} onClick=${take}>${t("setup.camera.snap")}</button>
    </p>
    <p class="help">${why || t("setup.camera.help")}</p>
    <div aria-live="polite">
      ${(suggestion.running || snap.running) && html`<p>${t("setup.running")}</p>`}
      ${suggestion.answer && html`<p>${t(suggestion.answer.reached ? "setup.camera.suggested" : "setup.camera.not_reached", {
        exposure: number(suggestion.answer.exposure_us, usefulDigits(suggestion.answer.exposure_us)), looks: suggestion.answer.looks })}</p>
        <div class="scroll"><${Grey} grey=${suggestion.answer.grey}/></div>`}
      ${snap.answer && html`<p>${t("setup.camera.kept", { path: snap.answer.path, width: snap.answer.width_px, height: snap.answer.height_px })}</p>
        <div class="scroll"><${Grey} grey=${snap.answer.grey}/></div>`}
    </div>
    <${Problem} text=${suggestion.problem || snap.problem}/>
  </section>`;
}
