// The axis with its soft limits and where the stage was seen last.
import { useEffect, useState } from "preact/hooks";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import { call } from "../../../rpc/rpc.ts";
import { limitsOf, shareOf } from "./stage_limits.ts";
import { stagePlace } from "./stage_place.ts";

interface Objectives {
  objectives: unknown;
  objective: string;
}

export function StageScale() {
  useLanguage();
  const place = useStore(stagePlace);
  const { health, state } = useStore(topics);
  const [known, setKnown] = useState<Objectives | null>(null);
  useEffect(() => {
    let gone = false;
    call("objective.list", {}).then((told) => gone || setKnown(told), () => undefined);  // its own panel tells errors
    return () => void (gone = true);
  }, [state?.objective]);

  const limits = limitsOf(health?.stage, known?.objectives, known?.objective ?? "");
  const own = (health?.stage as { z_um?: unknown } | undefined)?.z_um;
  const z_um = place?.z_um ?? (typeof own === "number" ? own : null);
  const where = z_um === null ? t("setup.stage.unknown") : t("setup.stage.at", { z: number(z_um, 2) });
  return html`<section class="panel scale" aria-labelledby="scale-title">
    <h2 id="scale-title">${t("setup.stage.title")}</h2>
    <p class="reading" aria-live="polite">${where}</p>
    ${limits === null
      ? html`<p class="help">${t("setup.stage.no_limits")}</p>`
      : html`<div class="axis">
          <svg viewBox="0 0 40 200" role="img" aria-label=${t("setup.stage.limits", { min: limits.min_um, max: limits.max_um })}>
            <line class="rail" x1="20" x2="20" y1="10" y2="190"/>
            <line class="limit" x1="4" x2="36" y1="10" y2="10"/>
            <line class="limit" x1="4" x2="36" y1="190" y2="190"/>
            ${z_um !== null && html`<path class="here" d=${`M20 ${190 - 180 * shareOf(z_um, limits)} l14 -8 v16 z`}/>`}
          </svg>
          <span class="ends"><span>${t("setup.stage.upper", { z: limits.max_um })}</span><span>${t("setup.stage.lower", { z: limits.min_um })}</span></span>
        </div>`}
  </section>`;
}
