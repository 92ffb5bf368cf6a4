// Rows of a parameter that is a list of objects, as the steps of known height: one row a job.
import { t, tWord, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { shownUnit } from "../../../lib/units.ts";
import type { Field } from "./study_fields.ts";
import { type Faults, type Row, emptyRow } from "./study_values.ts";

interface Props {
  field: Field;
  rows: Row[];
  faults: Faults;
  jobsList: string;  // id of a list of known jobs
  change: (rows: Row[]) => void;
}

export function RowsInput({ field, rows, faults, jobsList, change }: Props) {
  useLanguage();
  const nameOf = ({ name, unit }: Field): string => `${tWord("setup.param", name)}${unit ? ` (${shownUnit(unit)})` : ""}`;
  const set = (i: number, name: string, text: string): void => change(rows.map((row, at) => (at === i ? { ...row, [name]: text } : row)));
  return html`<div>
    ${rows.map((row, i) => html`<fieldset class="row" key=${i}>
      <legend>${t("setup.rows.one", { number: i + 1 })}</legend>
      <div class="fields">
        ${field.columns.map((column) => html`<label class="field" key=${column.name}>${nameOf(column)}
          <input value=${row[column.name] ?? ""} aria-invalid=${`${field.name}.${i}.${column.name}` in faults} title=${column.about}
            list=${column.kind === "job" ? jobsList : undefined} class=${column.kind === "number" ? "short" : ""}
            onInput=${(event: Event) => set(i, column.name, (event.target as HTMLInputElement).value)}/></label>`)}
      </div>
      <button type="button" disabled=${rows.length <= 1} aria-label=${t("setup.rows.remove_of", { number: i + 1 })}
        onClick=${() => change(rows.filter((_, at) => at !== i))}>${t("setup.rows.remove")}</button>
    </fieldset>`)}
    <p class="buttons"><button type="button" onClick=${() => {
      // The next artefact is mostly evaluated as the last one was.
      const last = rows.at(-1);
      change([...rows, { ...emptyRow(field), measurement: last?.["measurement"] ?? "", value: last?.["value"] ?? "height_um" }]);
    }}>${t("setup.rows.add")}</button></p>
  </div>`;
}
