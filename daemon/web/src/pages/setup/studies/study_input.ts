// One parameter of a study: its name, unit, range and default, the daemon's sentence about it, and what takes it.
import { number, t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { shownUnit } from "../../../lib/units.ts";
import { JobIdsInput } from "./job_ids_input.ts";
import type { KnownJobs } from "./known_jobs.ts";
import { RegionInput } from "./region_input.ts";
import { RowsInput } from "./rows_input.ts";
import { type Field, rangeText } from "./study_fields.ts";
import type { Faults, Region, Row, Value } from "./study_values.ts";

interface Props {
  field: Field;
  value: Value;
  faults: Faults;
  showsFaults: boolean;
  known: KnownJobs;
  jobsList: string;
  studiesList: string;
  change: (value: Value) => void;
}

function defaultText({ kind, fallback }: Field): string {
  if (fallback === undefined || fallback === "") return "";
  if (kind === "flag") return t(fallback ? "setup.yes" : "setup.no");
  return typeof fallback === "number" ? number(fallback) : String(fallback);
}

export function StudyInput({ field, value, faults, showsFaults, known, jobsList, studiesList, change }: Props) {
  useLanguage();
  const { name, kind } = field;
  const id = `study-${name}`;
  const helpId = `${id}-help`;
  const own = Object.keys(faults).filter((at) => at === name || at.startsWith(`${name}.`));
  const fault = showsFaults && own.length > 0 ? faults[own[0] ?? ""] : undefined;
  const label = `${tWord("setup.param", name)}${field.unit ? ` (${shownUnit(field.unit)})` : ""}${field.required ? " *" : ""}`;
  const asText = (event: Event): void => change((event.target as HTMLInputElement).value);
  const range = rangeText(field, (limit) => number(limit));
  const standing = defaultText(field);

  const shownFaults = showsFaults ? faults : {};
  const input = kind === "jobs" ? html`<${JobIdsInput} id=${id} ids=${value as string[]} known=${known} describedBy=${helpId} change=${change}/>`
    : kind === "rows" ? html`<${RowsInput} field=${field} rows=${value as Row[]} faults=${shownFaults} jobsList=${jobsList} change=${change}/>`
      : kind === "region" ? html`<${RegionInput} id=${id} name=${name} region=${value as Region} faults=${shownFaults} describedBy=${helpId} change=${change}/>`
        : kind === "choice" ? html`<select id=${id} value=${value as string} aria-describedby=${helpId} onChange=${asText}>
            ${field.options.map((each) => html`<option value=${each}>${tWord("setup.choice", each)}</option>`)}</select>`
          : kind === "flag" ? html`<input id=${id} type="checkbox" checked=${value as boolean} aria-describedby=${helpId}
              onChange=${(event: Event) => change((event.target as HTMLInputElement).checked)}/>`
            : html`<input id=${id} value=${value as string} aria-describedby=${helpId} aria-invalid=${fault !== undefined} aria-required=${field.required}
                class=${kind === "number" || kind === "integer" ? "short" : ""} list=${kind === "job" ? jobsList : kind === "study" ? studiesList : undefined} onInput=${asText}/>`;
  return html`<div class="param" role=${kind === "rows" ? "group" : undefined} aria-labelledby=${kind === "rows" ? `${id}-label` : undefined}>
    ${kind === "rows" ? html`<p class="label" id=${`${id}-label`}>${label}</p>` : html`<label for=${id} class="label">${label}</label>`}
    ${input}
    <p class="help" id=${helpId}>${field.about && html`<span lang="en">${field.about}</span>`}${range && html` · ${range}`}${standing && html` · ${t("setup.default", { value: standing })}`}
      ${fault && html`<strong class="problem"> ▲ ${tWord("setup.fault", fault)}</strong>`}</p>
  </div>`;
}
