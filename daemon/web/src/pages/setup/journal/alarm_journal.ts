// The newest warnings and errors of the daemon, the newest first.
import { useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import type { Alarm } from "../../../rpc/listed.ts";
import { call } from "../../../rpc/rpc.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { clockTime } from "./clock_time.ts";
import { newest } from "./newest_alarms.ts";

const kMarks: Record<Alarm["level"], string> = { warning: "△", error: "▲", critical: "✖" };
const kLevels = ["all", "warning", "error", "critical"] as const;

export function AlarmJournal() {
  useLanguage();
  const { alarms } = useStore(topics);
  const [level, setLevel] = useState<string>("all");
  const { running, problem, run } = useCommand<unknown>();
  const why = useRefusal({ role: "operate" });
  const shown = newest(alarms, level);
  return html`<section class="panel" aria-labelledby="alarms-title">
    <h2 id="alarms-title">${t("setup.journal.title")}</h2>
    <label class="field">${t("setup.journal.level")}
      <select value=${level} onChange=${(event: Event) => setLevel((event.target as HTMLSelectElement).value)}>
        ${kLevels.map((each) => html`<option value=${each}>${tWord("setup.level", each)}</option>`)}
      </select>
    </label>
    <${Problem} text=${problem}/>
    ${shown.length === 0
      ? html`<p class="help">${t("setup.journal.none")}</p>`
      : html`<div class="scroll tall" tabindex="0" role="group" aria-labelledby="alarms-title"><table>
          <tr><th scope="col">${t("setup.journal.time")}</th><th scope="col">${t("setup.journal.level")}</th><th scope="col">${t("setup.journal.text")}</th><th scope="col">${t("setup.journal.seen")}</th></tr>
          ${shown.map((alarm) => html`<tr key=${alarm.number}>
            <td class="time">${clockTime(alarm.time_utc)}</td>
            <td class=${`level ${alarm.level}`}><span aria-hidden="true">${kMarks[alarm.level] ?? "△"}</span> ${tWord("setup.level", alarm.level)}</td>
            <td class="long" dir="auto">${alarm.text}${alarm.count > 1 && ` (× ${alarm.count})`}</td>
            <td>${alarm.acknowledged ? t("setup.journal.acknowledged") : html`<button type="button" disabled=${why !== "" || running} title=${why}
              aria-label=${t("setup.journal.acknowledge_of", { number: alarm.number })}
              onClick=${() => void run(() => call("alarm.acknowledge", { number: alarm.number, time_utc: alarm.time_utc }))}>${t("setup.journal.acknowledge")}</button>`}</td>
          </tr>`)}
        </table></div>`}
  </section>`;
}
