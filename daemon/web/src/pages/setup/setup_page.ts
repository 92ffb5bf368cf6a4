// The page to set a station up: stage and camera by hand, studies, devices, journal.
import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { place } from "../../lib/router.ts";
import { useStore } from "../../lib/store.ts";
import "../../style/setup.css";
import { ControlStrip } from "./control_strip.ts";
import { DevicesView } from "./devices/devices_view.ts";
import { JournalView } from "./journal/journal_view.ts";
import { MotionView } from "./motion/motion_view.ts";
import { StudiesView } from "./studies/studies_view.ts";

const kParts = [
  ["motion", "setup.part.motion", MotionView],
  ["studies", "setup.part.studies", StudiesView],
  ["devices", "setup.part.devices", DevicesView],
  ["journal", "setup.part.journal", JournalView],
] as const;

export function SetupPage() {
  useLanguage();
  const { query } = useStore(place);
  const [name, , Part] = kParts.find(([each]) => each === query.get("part")) ?? kParts[0];
  return html`<div class="setup">
    <h1>${t("nav.setup")}</h1>
    <nav class="parts" aria-label=${t("setup.parts")}>
      ${kParts.map(([each, key]) => html`<a class="button" href=${`/setup?part=${each}`} aria-current=${each === name ? "page" : undefined}>${t(key)}</a>`)}
    </nav>
    <${ControlStrip}/>
    <${Part}/>
  </div>`;
}
