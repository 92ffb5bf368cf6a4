// Tests of the instrument, constants, gauge studies: each a sequence that ends in figures and a report.
import { useEffect, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { call } from "../../../rpc/rpc.ts";
import { Problem } from "../problem.ts";
import { kKinds } from "./kinds.ts";
import { StudyForm } from "./study_form.ts";
import { StudyList } from "./study_list.ts";
import { StudyReport } from "./study_report.ts";
import type { ListedStudy, StudyReply } from "./study_types.ts";

interface Made {
  studies: ListedStudy[];
  broken: { id: string; reason: string }[];
}

export function StudiesView() {
  useLanguage();
  const [method, setMethod] = useState("verify.noise");
  const [made, setMade] = useState<Made>({ studies: [], broken: [] });
  const [shown, setShown] = useState<StudyReply | null>(null);
  const [problem, setProblem] = useState("");

  const tell = (error: unknown): void => setProblem(messageOf(error));
  const fetchList = (): void => void call("study.list", {}).then((told) => setMade(told as Made), tell);
  useEffect(fetchList, []);
  const show = (reply: StudyReply): void => {
    setShown(reply);
    setProblem("");
    fetchList();
    requestAnimationFrame(() => document.getElementById("report-title")?.focus());
  };
  const open = (id: string): void => void call("study.get", { id }).then((told) => show(told as StudyReply), tell);

  return html`<div class="pairs roomy">
    <div class="panels">
      <section class="panel" aria-labelledby="study-title">
        <h2 id="study-title">${t("setup.study.title")}</h2>
        <label class="field">${t("setup.study.kind")}
          <select value=${method} onChange=${(event: Event) => setMethod((event.target as HTMLSelectElement).value)}>
            ${kKinds.map(([group, names]) => html`<optgroup label=${tWord("setup.group", group)}>
              ${names.map((name) => html`<option value=${`${group}.${name}`}>${tWord("setup.kind", `${group}.${name}`)}</option>`)}
            </optgroup>`)}
          </select>
        </label>
        <${StudyForm} key=${method} method=${method} studies=${made.studies.map(({ id }) => id)} made=${show}/>
      </section>
    </div>
    <div class="panels">
      <${Problem} text=${problem}/>
      ${shown && html`<${StudyReport} reply=${shown} calibration=${made.studies.find(({ id }) => id === shown.study.id)?.calibration} accepted=${fetchList}/>`}
      <${StudyList} studies=${made.studies} broken=${made.broken} open=${open}/>
    </div>
  </div>`;
}
