// Whether camera, stage and disk are there, and what their lines counted.
import { number, t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { usefulDigits } from "../../../lib/digits.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { numbersOf } from "../../../live/health_history.ts";
import { topics } from "../../../live/live.ts";

interface Device {
  open?: boolean;
}

// Counters that are above zero when a line is bad.
const kBad = /failed|underruns|skipped|missing|resent|retries|unanswered|refused|reconnects|implausible|discarded/;

function Light({ name, isGood, text }: { name: string; isGood: boolean; text: string }) {
  return html`<li class=${isGood ? "good" : "bad"}><span aria-hidden="true">${isGood ? "●" : "▲"}</span> ${name}: ${text}</li>`;
}

function Counters({ device, about }: { device: "camera" | "stage"; about: unknown }) {
  const numbers = numbersOf(about);
  const id = `counters-${device}`;
  return html`<h3 id=${id}>${t(device === "camera" ? "setup.health.camera_counters" : "setup.health.stage_counters")}</h3>
    <table aria-labelledby=${id}>
      <tr class="hidden"><th scope="col">${t("setup.health.counter")}</th><th scope="col">${t("setup.health.value")}</th></tr>
      ${Object.entries(numbers).map(([name, value]) => html`<tr key=${name}>
        <th scope="row">${tWord("setup.counter", name)}</th>
        <td class="number">${value > 0 && kBad.test(name) && html`<span class="warn"><span aria-hidden="true">△ </span><span class="hidden">${t("setup.health.look")} </span></span>`}${number(value, usefulDigits(value, 3))}</td>
      </tr>`)}
    </table>`;
}

export function DeviceHealth() {
  useLanguage();
  const { health, state } = useStore(topics);
  if (health === null) return html`<section class="panel"><h2>${t("setup.health.title")}</h2><p class="help">${t("setup.health.none")}</p></section>`;
  const camera = (health.camera ?? {}) as Device;
  const stage = (health.stage ?? {}) as Device;
  const disk = health.disk as { free_bytes?: number; size_bytes?: number } | undefined;
  const stalled = (health.stalled_threads ?? []) as string[];
  const free = disk?.free_bytes;
  const share = free !== undefined && disk?.size_bytes ? free / disk.size_bytes : null;
  const open = (device: Device): string => t(device.open ? "setup.health.open" : "setup.health.gone");
  return html`<section class="panel" aria-labelledby="health-title">
    <h2 id="health-title">${t("setup.health.title")}</h2>
    <ul class="lights">
      <${Light} name=${t("setup.health.daemon")} isGood=${health.ok} text=${health.ok ? t("setup.health.ok") : state?.error_message || t("setup.health.not_ok")}/>
      <${Light} name=${t("setup.health.camera")} isGood=${camera.open === true} text=${open(camera)}/>
      <${Light} name=${t("setup.health.stage")} isGood=${stage.open === true} text=${open(stage)}/>
      ${share !== null && html`<${Light} name=${t("setup.health.disk")} isGood=${share > 0.05} text=${t("setup.health.free", { free: number((free ?? 0) / 1e9, 1), percent: number(100 * share, 0) })}/>`}
      ${stalled.length > 0 && html`<${Light} name=${t("setup.health.threads")} isGood=${false} text=${stalled.join(", ")}/>`}
    </ul>
    <div class="pairs"><div><${Counters} device="camera" about=${health.camera}/></div><div><${Counters} device="stage" about=${health.stage}/></div></div>
  </section>`;
}
