// Several jobs: ticked in the list of the newest, or typed; their order is the text's.
import { useState } from "preact/hooks";
import { t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { clockTime } from "../journal/clock_time.ts";
import { idsIn, withId } from "./ids_text.ts";
import type { KnownJobs } from "./known_jobs.ts";

interface Props {
  id: string;
  ids: string[];
  known: KnownJobs;
  describedBy: string;
  change: (ids: string[]) => void;
}

export function JobIdsInput({ id, ids, known, describedBy, change }: Props) {
  useLanguage();
  const [typed, setTyped] = useState<string | null>(null);  // while somebody types, blanks and half ids stay
  const [filter, setFilter] = useState("");
  const wanted = filter.trim().toLowerCase();
  const jobs = known.jobs.filter(({ part_id, recipe, job_id }) => `${part_id} ${recipe} ${job_id}`.toLowerCase().includes(wanted));
  // The list is the newest first; scans of a study are wanted in the order in which they were made.
  const addAll = (): void => change([...jobs].reverse().reduce((all, job) => withId(all, job.job_id, true), ids));
  return html`<div class="jobs">
    <textarea id=${id} rows="4" spellcheck=${false} aria-describedby=${describedBy} value=${typed ?? ids.join("\n")}
      onInput=${(event: Event) => {
        const { value } = event.target as HTMLTextAreaElement;
        setTyped(value);
        change(idsIn(value));
      }}
      onBlur=${() => setTyped(null)}></textarea>
    <p class="help">${t("setup.jobs.chosen", { count: ids.length })}</p>
    ${!known.isListed && html`<p class="help">${t("setup.jobs.not_listed")}</p>`}
    ${known.jobs.length > 0 && html`<details>
      <summary>${t("setup.jobs.choose")}</summary>
      <label class="field">${t("setup.jobs.filter")} <input value=${filter} onInput=${(event: Event) => setFilter((event.target as HTMLInputElement).value)}/></label>
      <ul class="choices scroll tall" tabindex="0" aria-label=${t("setup.jobs.choose")}>
        ${jobs.map((job) => html`<li key=${job.job_id}><label class="check"><input type="checkbox" checked=${ids.includes(job.job_id)}
          onChange=${(event: Event) => change(withId(ids, job.job_id, (event.target as HTMLInputElement).checked))}/>
          <span><bdi>${job.part_id}</bdi> · ${job.recipe} · ${clockTime(job.ended_utc)}<br/><small>${job.job_id}</small></span></label></li>`)}
      </ul>
      <p class="buttons"><button type="button" onClick=${addAll}>${t("setup.jobs.all")}</button>
        <button type="button" onClick=${() => change([])}>${t("setup.jobs.clear")}</button></p>
    </details>`}
  </div>`;
}
