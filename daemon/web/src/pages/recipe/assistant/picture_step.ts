// The live picture, and the exposure.
import { useState } from "preact/hooks";
import { asCommand } from "../../../camera/devices_turn.ts";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { CameraPicture } from "../../../parts/camera_picture.ts";
import { getAt } from "../../../recipe/document.ts";
import { recipeSchema } from "../../../recipe/schema.ts";
import { call } from "../../../rpc/rpc.ts";
import { Field } from "../fields/field.ts";
import type { StepProps } from "./assistant.ts";
import { useRun } from "./run.ts";

const kExposure = ["acquire", "camera", "exposure_us"] as const;

export function PictureStep({ editor }: StepProps) {
  const [said, setSaid] = useState("");
  const [near, setNear] = useState<{ exposure_us: number; looks: number } | null>(null);
  const { why, run, view } = useRun();
  const exposure = getAt(editor.document ?? undefined, kExposure);
  const given = typeof exposure === "number" ? { exposure_us: exposure } : {};

  const suggest = (): Promise<void> => asCommand(async () => {
    setSaid("");
    setNear(null);
    const found = await call("camera.suggest_exposure", given);
    const exposure_us = Number(found.exposure_us.toPrecision(3));
    // One that did not reach the brightness may be far off, as with no light at all: it is for people to take.
    if (!found.reached) {
      setNear({ exposure_us, looks: found.looks });
      return;
    }
    editor.set(kExposure, exposure_us);
    setSaid(t("recipe.exposure_found", { exposure: exposure_us, looks: found.looks }));
  });
  const schema = recipeSchema.properties?.["acquire"]?.properties?.["camera"]?.properties?.["exposure_us"] ?? {};
  return html`
    <${CameraPicture} params=${given}/>
    <p class="buttons"><button type="button" disabled=${why !== ""} onClick=${() => run(t("recipe.seeking_exposure"), suggest)}>${t("recipe.suggest_exposure")}</button></p>
    ${view}
    <div aria-live="polite">${near
      ? html`<p class="panel notice">${t("recipe.exposure_near", { exposure: near.exposure_us, looks: near.looks })}</p>
        <p class="buttons"><button type="button" onClick=${() => {
          editor.set(kExposure, near.exposure_us);
          setNear(null);
        }}>${t("recipe.take_exposure", { exposure: near.exposure_us })}</button></p>`
      : html`<p>${said}</p>`}</div>
    <${Field} editor=${editor} schema=${schema} path=${kExposure} required=${false}/>`;
}
