// The live picture, and the exposure.
import { useEffect, useState } from "preact/hooks";
import { number, t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { getAt } from "../../../recipe/document.ts";
import { recipeSchema } from "../../../recipe/schema.ts";
import { call } from "../../../rpc/rpc.ts";
import { Field } from "../fields/field.ts";
import type { StepProps } from "./assistant.ts";
import { useRun } from "./run.ts";

const kExposure = ["acquire", "camera", "exposure_us"] as const;

interface Picture {
  address: string;
  z_um: number;
  focus: number;
  saturated: number;
}

export function PictureStep({ editor }: StepProps) {
  const [picture, setPicture] = useState<Picture | null>(null);
  const [said, setSaid] = useState("");
  const { why, run, view } = useRun();
  useEffect(() => () => { if (picture) URL.revokeObjectURL(picture.address); }, [picture]);
  const exposure = getAt(editor.document ?? undefined, kExposure);
  const given = typeof exposure === "number" ? { exposure_us: exposure } : {};

  const look = async (settings: { exposure_us?: number }): Promise<void> => {
    const { png_base64, z_um, focus, saturated_fraction } = await call("camera.preview", settings);
    const bytes = Uint8Array.from(atob(png_base64), (letter) => letter.charCodeAt(0));
    setPicture({ address: URL.createObjectURL(new Blob([bytes], { type: "image/png" })), z_um, focus, saturated: saturated_fraction });
  };
  const suggest = async (): Promise<void> => {
    const found = await call("camera.suggest_exposure", given);
    const exposure_us = Number(found.exposure_us.toPrecision(3));
    editor.set(kExposure, exposure_us);
    setSaid(t(found.reached ? "recipe.exposure_found" : "recipe.exposure_near", { exposure: exposure_us, looks: found.looks }));
    await look({ exposure_us });
  };
  const schema = recipeSchema.properties?.["acquire"]?.properties?.["camera"]?.properties?.["exposure_us"] ?? {};
  return html`
    <p class="buttons">
      <button type="button" disabled=${why !== ""} onClick=${() => run(t("recipe.looking"), () => look(given))}>${t("recipe.look")}</button>
      <button type="button" disabled=${why !== ""} onClick=${() => run(t("recipe.seeking_exposure"), suggest)}>${t("recipe.suggest_exposure")}</button>
    </p>
    ${view}
    <p aria-live="polite">${said}</p>
    ${picture && html`<figure><img class="preview" src=${picture.address} alt=${t("recipe.picture_label")}/>
      <figcaption>${t("recipe.picture_facts", { z: number(picture.z_um, 2), focus: number(picture.focus, 1), saturated: number(100 * picture.saturated, 2) })}</figcaption></figure>`}
    <${Field} editor=${editor} schema=${schema} path=${kExposure} required=${false}/>`;
}
