// What went wrong, and who asked for what.
import { html } from "../../../lib/html.ts";
import { AlarmJournal } from "./alarm_journal.ts";
import { AuditTable } from "./audit_table.ts";

export function JournalView() {
  return html`<div class="panels"><${AlarmJournal}/><${AuditTable}/></div>`;
}
