// Stage and camera by hand.
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { CameraPicture } from "../../../parts/camera_picture.ts";
import { AutofocusForm } from "./autofocus_form.ts";
import { CameraCommands } from "./camera_commands.ts";
import { JogButtons } from "./jog_buttons.ts";
import { isLight, light, lightParams } from "./light.ts";
import { StageCommands } from "./stage_commands.ts";
import { sawStageAt } from "./stage_place.ts";
import { StageScale } from "./stage_scale.ts";

export function MotionView() {
  const settings = useStore(light);
  return html`<div class="motion">
    <${CameraPicture} params=${isLight(settings) ? lightParams(settings) : {}} onPlace=${sawStageAt}/>
    <div class="panels"><${StageScale}/><${JogButtons}/><${StageCommands}/></div>
    <div class="panels"><${CameraCommands}/><${AutofocusForm}/></div>
  </div>`;
}
