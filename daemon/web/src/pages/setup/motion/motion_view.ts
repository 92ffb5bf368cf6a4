// Stage and camera by hand.
import { html } from "../../../lib/html.ts";
import { AutofocusForm } from "./autofocus_form.ts";
import { CameraCommands } from "./camera_commands.ts";
import { JogButtons } from "./jog_buttons.ts";
import { LivePicture } from "./live_picture.ts";
import { StageCommands } from "./stage_commands.ts";
import { StageScale } from "./stage_scale.ts";

export function MotionView() {
  return html`<div class="motion">
    <${LivePicture}/>
    <div class="panels"><${StageScale}/><${JogButtons}/><${StageCommands}/></div>
    <div class="panels"><${CameraCommands}/><${AutofocusForm}/></div>
  </div>`;
}
