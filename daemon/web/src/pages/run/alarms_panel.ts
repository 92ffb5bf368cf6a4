// What went wrong: when, what, what to do, and who has seen it.
import { useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import type { Alarm } from "../../rpc/listed.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";
import { ordered, timeForPeople } from "../../run/alarm_order.ts";
import { errorCodeIn, isWanted, saidOnce } from "../../run/error_in_text.ts";
import { whatToDo } from "./what_to_do.ts";

// A stop that somebody pressed is told as a notice, whatever the log calls it.
type Look = Alarm["level"] | "notice";

const kShapes: Record<Look, string> = {
  notice: "M12 2a10 10 0 1 0 0 20 10 10 0 0 0 0-20ZM11 6h2v3h-2ZM11 11h2v7h-2Z",
  warning: "M12 3 22 21H2Z",
  error: "M7 2h10l5 5v10l-5 5H7l-5-5V7Z",
  critical: "M12 1 15 9 23 12 15 15 12 23 9 15 1 12 9 9Z",
};

function AlarmRow({ alarm, mayAcknowledge, acknowledge }: { alarm: Alarm; mayAcknowledge: boolean; acknowledge: (alarm: Alarm) => void }) {
  const language = useLanguage();
  const todo = whatToDo(errorCodeIn(alarm.text)) || tWord("run.alarm_todo", alarm.level);
  const text = saidOnce(alarm.text);
  const look: Look = isWanted(alarm) ? "notice" : alarm.level;
  return html`<li class=${`alarm alarm-${look} ${alarm.acknowledged ? "seen" : ""}`}>
    <svg width="24" height="24" viewBox="0 0 24 24" fill="currentColor" aria-hidden="true"><path d=${kShapes[look] ?? kShapes.error}/></svg>
    <div>
      <p><strong>${tWord("run.alarm_level", look)}</strong> <time datetime=${alarm.time_utc}>${timeForPeople(alarm.time_utc, language)}</time></p>
      <p class="alarm-text" dir="auto">${text}${alarm.count > 1 && ` (× ${alarm.count})`}</p>
      <p class="help">${todo}</p>
    </div>
    ${alarm.acknowledged
      ? html`<span class="help">${t("run.acknowledged")}</span>`
      : html`<button type="button" disabled=${!mayAcknowledge} title=${mayAcknowledge ? undefined : t("run.why.no_role")}
          aria-label=${t("run.acknowledge_this", { text })} onClick=${() => acknowledge(alarm)}>${t("run.acknowledge")}</button>`}
  </li>`;
}

export function AlarmsPanel() {
  useLanguage();
  const { alarms } = useStore(topics);
  const { role } = useStore(session);
  const [problem, setProblem] = useState("");
  const acknowledge = ({ number, time_utc }: Alarm): void => {
    setProblem("");
    call("alarm.acknowledge", { number, time_utc }).catch((error: unknown) => setProblem(messageOf(error)));
  };
  const list = ordered(alarms ?? []);
  const waiting = list.filter(({ acknowledged }) => !acknowledged).length;
  const warns = list.some((alarm) => !alarm.acknowledged && !isWanted(alarm));
  return html`<section class=${`panel alarms ${warns ? "waiting" : ""}`} aria-labelledby="alarms-title">
    <h2 id="alarms-title">${t("run.alarms")} ${waiting > 0 && html`<span class="tag">${t("run.alarms_waiting", { count: waiting })}</span>`}</h2>
    ${list.length === 0 && html`<p class="help">${t("run.no_alarms")}</p>`}
    <div role="alert"><ul class="alarm-list" tabindex="0">${list.map((alarm) => html`<${AlarmRow} key=${alarm.number} alarm=${alarm} mayAcknowledge=${mayAs(role, "operate")} acknowledge=${acknowledge}/>`)}</ul></div>
    ${waiting > 0 && !mayAs(role, "operate") && html`<p class="help">${t("run.why.no_role")}</p>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
  </section>`;
}
