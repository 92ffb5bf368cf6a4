// A study step by step: scan, choose the scans, say what is known of the artefact, run, read.
import { useEffect, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { messageOf } from "../../../parts/message_of.ts";
import type { Role } from "../../../rpc/session.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { describedMethods } from "./described_methods.ts";
import { proposes } from "./kinds.ts";
import { useKnownJobs } from "./known_jobs.ts";
import { runStudy } from "./run_study.ts";
import { type Field, type Method, fieldsOf } from "./study_fields.ts";
import { StudyInput } from "./study_input.ts";
import type { StudyReply } from "./study_types.ts";
import { type Values, emptyValue, paramsOf } from "./study_values.ts";

interface Props {
  method: string;
  studies: string[];  // ids of those that were made
  made: (reply: StudyReply) => void;
}

const kAboutScans = new Set(["job", "jobs", "rows"]);
const isOfScans = ({ kind }: Field): boolean => kAboutScans.has(kind);

export function StudyForm({ method, studies, made }: Props) {
  useLanguage();
  const known = useKnownJobs();
  const [about, setAbout] = useState<Method | null>(null);
  const [trouble, setTrouble] = useState("");
  const [values, setValues] = useState<Values>({});
  const [wasTried, setWasTried] = useState(false);
  const { running, problem, run } = useCommand<StudyReply>();
  const why = useRefusal({ role: (about?.["x-role"] ?? "set_up") as Role });

  useEffect(() => {
    let gone = false;
    describedMethods().then(
      (methods) => gone || setAbout(methods.find(({ name }) => name === method) ?? null),
      (error: unknown) => gone || setTrouble(messageOf(error)));
    return () => void (gone = true);
  }, [method]);

  if (about === null) return trouble ? html`<${Problem} text=${trouble}/>` : html`<p class="help">${t("setup.study.wait")}</p>`;
  const fields = fieldsOf(about);
  const { params, faults } = paramsOf(fields, values);
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    setWasTried(true);
    if (Object.keys(faults).length > 0) {
      const first = (Object.keys(faults)[0] ?? "").split(".")[0] ?? "";
      document.getElementById(`study-${first}`)?.focus();
      return;
    }
    const reply = await run(() => runStudy(method, params));
    if (reply) made(reply);
  };
  const inputs = (shown: Field[]) => shown.map((field) => html`<${StudyInput} key=${field.name} field=${field} value=${values[field.name] ?? emptyValue(field)}
    faults=${faults} showsFaults=${wasTried} known=${known} jobsList="study-jobs-known" studiesList="study-studies-known"
    change=${(value: Values[string]) => setValues((now) => ({ ...now, [field.name]: value }))}/>`);
  const parameters = fields.filter((field) => !isOfScans(field));
  const needed = parameters.filter(({ required }) => required);
  const optional = parameters.filter(({ required }) => !required);
  return html`<form class="study" onSubmit=${submit} novalidate>
    <datalist id="study-jobs-known">${known.jobs.map((job) => html`<option key=${job.job_id} value=${job.job_id}>${job.part_id}, ${job.recipe}</option>`)}</datalist>
    <datalist id="study-studies-known">${studies.map((id) => html`<option key=${id} value=${id}/>`)}</datalist>
    <ol class="steps">
      <li><h3>${t("setup.study.step_scan")}</h3><p>${tWord("setup.guide", method)}</p><p><a href="/">${t("setup.study.to_run")}</a></p></li>
      ${fields.some(isOfScans) && html`<li><h3>${t("setup.study.step_choose")}</h3>${inputs(fields.filter(isOfScans))}</li>`}
      <li><h3>${t("setup.study.step_know")}</h3>${inputs(needed)}
        ${optional.length > 0 && html`<details><summary>${t("setup.study.more")}</summary>${inputs(optional)}</details>`}</li>
      <li><h3>${t("setup.study.step_run")}</h3>
        <p class="help">${t(proposes(method) ? "setup.study.proposes" : "setup.study.changes_nothing")}</p>
        <p class="buttons"><button type="submit" class="main" disabled=${why !== "" || running}>${t("setup.study.run")}</button></p>
        <p class="help" aria-live="polite">${running ? t("setup.study.running") : why}</p>
        ${wasTried && Object.keys(faults).length > 0 && html`<${Problem} text=${t("setup.study.faults", { count: Object.keys(faults).length })}/>`}
        <${Problem} text=${problem}/></li>
    </ol>
  </form>`;
}
