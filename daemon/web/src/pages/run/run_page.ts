// The one screen to run a station.
import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import "../../style/run.css";
import { AlarmsPanel } from "./alarms_panel.ts";
import { ControlPanel } from "./control_panel.ts";
import { DevicesPanel } from "./devices_panel.ts";
import { LastParts } from "./last_parts.ts";
import { LivePicture } from "./live_picture.ts";
import { Progress } from "./progress.ts";
import { MapPanel, ValuesPanel } from "./result_panels.ts";
import { StartPanel } from "./start_panel.ts";
import { StateBanner } from "./state_banner.ts";
import { useResult } from "./use_result.ts";

export function RunPage() {
  useLanguage();
  const shown = useResult();
  return html`<h1 class="hidden">${t("nav.run")}</h1>
    <${StateBanner}/>
    <div class="run">
      <div class="run-left"><${StartPanel}/><${Progress}/></div>
      <div class="run-right">
        <${LivePicture}/>
        <${MapPanel} shown=${shown}/>
        <${ValuesPanel} shown=${shown}/>
        <${LastParts}/>
        <${AlarmsPanel}/>
      </div>
      <div class="run-foot"><${ControlPanel}/><${DevicesPanel}/></div>
    </div>`;
}
