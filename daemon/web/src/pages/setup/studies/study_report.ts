// What a study found: figures with their uncertainties, what it warns of, where its report lies, and what it proposes.
import { number, t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { clockTime } from "../journal/clock_time.ts";
import { AcceptForm } from "./accept_form.ts";
import { figureText } from "./figure_text.ts";
import type { StudyReply } from "./study_types.ts";

const textOf = (entry: unknown): string => {
  const { text } = (entry ?? {}) as { text?: unknown };
  return typeof text === "string" ? text : typeof entry === "string" ? entry : JSON.stringify(entry);
};

interface Props {
  reply: StudyReply;
  calibration: string | null | undefined;  // the version that was made of it
  accepted: () => void;
}

export function StudyReport({ reply, calibration, accepted }: Props) {
  useLanguage();
  const { study, report } = reply;
  return html`<section class="panel" aria-labelledby="report-title">
    <h2 id="report-title" tabindex="-1">${tWord("setup.kind", study.kind)} · ${study.id}</h2>
    <p class="help">${clockTime(study.time)}${study.person && ` · ${study.person}`} · ${t("setup.report.scans", { count: study.jobs.length })}${study.simulated ? ` · ${t("setup.report.simulated")}` : ""}</p>
    <div class="scroll" tabindex="0" role="group" aria-labelledby="report-title"><table>
      <tr><th scope="col">${t("setup.report.figure")}</th><th scope="col" class="number">${t("setup.report.value")}</th><th scope="col">${t("setup.report.uncertainty")}</th><th scope="col">${t("setup.report.unit")}</th></tr>
      ${study.figures.map((figure) => {
        const { value, uncertainty, unit } = figureText(figure, number);
        return html`<tr key=${figure.name}><th scope="row">${tWord("setup.figure", figure.name)}</th><td class="number">${value}</td>
          <td>${uncertainty}${figure.reason}</td><td>${unit}</td></tr>`;
      })}
    </table></div>
    ${study.warnings.length > 0 && html`<h3>${t("setup.report.warnings")}</h3><ul>${study.warnings.map((each) => html`<li><span aria-hidden="true">△ </span><span lang="en">${textOf(each)}</span></li>`)}</ul>`}
    ${study.refusals.length > 0 && html`<h3>${t("setup.report.refusals")}</h3><ul>${study.refusals.map((each) => html`<li class="problem"><span aria-hidden="true">▲ </span><span lang="en">${textOf(each)}</span></li>`)}</ul>`}
    ${report && html`<p>${t("setup.report.file")} <code>${report}</code></p>`}
    <details><summary>${t("setup.report.jobs")}</summary><ul>${study.jobs.map((id) => html`<li key=${id}><a href=${`/jobs/${encodeURIComponent(id)}`}>${id}</a></li>`)}</ul></details>
    ${study.proposal && html`<${AcceptForm} key=${study.id} study=${study} calibration=${calibration} accepted=${accepted}/>`}
  </section>`;
}
