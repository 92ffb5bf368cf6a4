// Camera, stage, disk, and since when the constants are in force.
import { useEffect, useState } from "preact/hooks";
import { number, t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, resyncs, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { look } from "../../rpc/look.ts";
import { RpcError } from "../../rpc/rpc.ts";
import { type Device, deviceOf, diskOf } from "../../run/health.ts";
import { timeForPeople } from "../../run/alarm_order.ts";

const kNoCalibration = 1143;

interface Calibration {
  state: "unknown" | "none" | "there" | "lapsed" | "problem";
  text: string;
}

function useCalibration(): Calibration {
  const language = useLanguage();
  const { state } = useStore(topics);
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  const objective = state?.objective ?? "";
  const [told, setTold] = useState<{ id: string; created: string; lapsed: string[] } | Error | null>(null);
  useEffect(() => {
    if (!isLinked) return;
    look("calibration.get", objective ? { objective } : {}).then(({ calibration, lapsed }) => {
      const { id, created } = (calibration ?? {}) as { id?: unknown; created?: unknown };
      setTold({ id: String(id ?? ""), created: String(created ?? ""), lapsed: Array.isArray(lapsed) ? lapsed.map(String) : [] });
    }, (error: unknown) => setTold(error instanceof Error ? error : new Error(String(error))));
  }, [objective, count, isLinked]);
  if (told === null) return { state: "unknown", text: "–" };
  if (told instanceof RpcError && told.code === kNoCalibration) return { state: "none", text: t("run.calibration_none") };
  if (told instanceof Error) return { state: "problem", text: messageOf(told) };
  const text = t("run.calibration_of", { id: told.id, date: timeForPeople(told.created, language) });
  return told.lapsed.length > 0
    ? { state: "lapsed", text: `${text} ${t("run.calibration_lapsed", { parts: told.lapsed.join(", ") })}` }
    : { state: "there", text };
}

// A shape as well as a colour: a filled dot, a ring, a triangle.
function Light({ kind }: { kind: "good" | "warn" | "bad" }) {
  return html`<svg class=${`light light-${kind}`} width="20" height="20" viewBox="0 0 24 24" fill="currentColor" aria-hidden="true">${
    kind === "good" ? html`<circle cx="12" cy="12" r="9"/>`
    : kind === "warn" ? html`<path d="M12 3 22 21H2Z"/>`
    : html`<path d="M4 4 20 20M20 4 4 20" fill="none" stroke="currentColor" stroke-width="4"/>`}</svg>`;
}

function DeviceRow({ name, device }: { name: string; device: Device | null }) {
  const more = device === null ? [] : [
    ...(device.lost > 0 ? [device.lost === 1 ? t("run.device_lost_once") : t("run.device_lost", { count: device.lost })] : []),
    ...device.faults.map((fault) => tWord("run.fault", fault.name, { count: fault.count })),
    ...device.temperatures_c.map(({ name: where, celsius }) => `${where} ${number(celsius, 1)} °C`),
  ];
  return html`<dt>${name}</dt><dd>
    ${device === null ? "–" : html`<${Light} kind=${device.isOpen ? "good" : "bad"}/> <strong>${t(device.isOpen ? "run.device_open" : "run.device_closed")}</strong>`}
    ${more.length > 0 && html`<span class="help"> ${more.join(" · ")}</span>`}</dd>`;
}

export function DevicesPanel() {
  useLanguage();
  const { health, state } = useStore(topics);
  const calibration = useCalibration();
  const disk = diskOf(health?.disk);
  const stalled = Array.isArray(health?.stalled_threads) ? health.stalled_threads.map(String) : [];
  return html`<section class="panel devices" aria-labelledby="devices-title">
    <h2 id="devices-title">${t("run.devices")}</h2>
    <dl class="figures">
      <${DeviceRow} name=${t("run.camera")} device=${health && deviceOf(health.camera)}/>
      <${DeviceRow} name=${t("run.stage")} device=${health && deviceOf(health.stage)}/>
      <dt>${t("run.disk")}</dt><dd>${disk === null ? "–" : html`<${Light} kind=${disk.isLow ? "warn" : "good"}/> ${t("run.disk_free", { free: number(disk.free_gib, 1), share: number(100 * disk.free_share, 0) })}`}</dd>
      <dt>${t("run.calibration")}</dt><dd>${calibration.state !== "unknown" && html`<${Light} kind=${calibration.state === "there" ? "good" : "warn"}/>`} ${calibration.text}</dd>
      ${state?.objective && html`<dt>${t("run.objective")}</dt><dd>${state.objective}</dd>`}
      <dt>${t("run.results_waiting")}</dt><dd class=${state?.overrun ? "problem" : undefined}>${state ? number(state.results_waiting) : "–"}${state?.overrun && ` – ${t("run.overrun")}`}</dd>
    </dl>
    ${stalled.length > 0 && html`<p class="problem" role="alert">${t("run.stalled", { names: stalled.join(", ") })}</p>`}
  </section>`;
}
