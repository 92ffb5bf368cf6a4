// The studies that were made, the newest first.
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { clockTime } from "../journal/clock_time.ts";
import type { ListedStudy } from "./study_types.ts";

interface Props {
  studies: ListedStudy[];
  broken: { id: string; reason: string }[];
  open: (id: string) => void;
}

export function StudyList({ studies, broken, open }: Props) {
  useLanguage();
  return html`<section class="panel" aria-labelledby="studies-title">
    <h2 id="studies-title">${t("setup.studies.title")}</h2>
    ${studies.length === 0 ? html`<p class="help">${t("setup.studies.none")}</p>` : html`<div class="scroll tall studies" tabindex="0" role="group" aria-labelledby="studies-title"><table>
      <tr><th scope="col">${t("setup.studies.id")}</th><th scope="col">${t("setup.studies.kind")}</th><th scope="col">${t("setup.journal.time")}</th><th scope="col">${t("setup.studies.person")}</th><th scope="col">${t("setup.studies.state")}</th></tr>
      ${studies.map((study) => html`<tr key=${study.id}>
        <td><button type="button" onClick=${() => open(study.id)} aria-label=${t("setup.studies.open", { id: study.id })}>${study.id}</button></td>
        <td>${tWord("setup.kind", study.kind)}</td><td class="time">${clockTime(study.time)}</td><td class="long" dir="auto">${study.person}</td>
        <td>${study.warnings > 0 && t("setup.studies.warnings", { count: study.warnings })} ${study.calibration === undefined ? "" : study.calibration === null ? t("setup.studies.proposed") : t("setup.studies.accepted", { version: study.calibration })}</td>
      </tr>`)}
    </table></div>`}
    ${broken.map(({ id, reason }) => html`<p class="problem" key=${id}>▲ ${id}: ${reason}</p>`)}
  </section>`;
}
