// Who asked for what, a page at a time.
import { useEffect, useState } from "preact/hooks";
import { t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { call } from "../../../rpc/rpc.ts";
import { useStore } from "../../../lib/store.ts";
import { session } from "../../../rpc/session.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import { clockTime } from "./clock_time.ts";

interface Entry {
  number: number;
  time_utc: string;
  who: string;
  role: string;
  peer: string;
  client: string;
  what: string;
  detail: string;
  outcome: string;
}

const kPage = 50;

export function AuditTable() {
  useLanguage();
  const { who } = useStore(session);
  const [entries, setEntries] = useState<Entry[]>([]);
  const [isAll, setIsAll] = useState(false);
  const { running, problem, run } = useCommand<void>();

  const fetchPage = (known: Entry[]): void => void run(async () => {
    const before = known.at(-1)?.number ?? 0;
    const told = (await call("audit.list", { most: kPage, before })).entries as Entry[];
    setEntries([...known, ...told]);
    setIsAll(told.length < kPage);
  });
  useEffect(() => fetchPage([]), [who]);

  return html`<section class="panel" aria-labelledby="audit-title">
    <h2 id="audit-title">${t("setup.audit.title")}</h2>
    <${Problem} text=${problem}/>
    <div class="scroll tall" tabindex="0" role="group" aria-labelledby="audit-title"><table>
      <tr><th scope="col">${t("setup.journal.time")}</th><th scope="col">${t("setup.audit.who")}</th><th scope="col">${t("setup.audit.what")}</th><th scope="col">${t("setup.audit.outcome")}</th><th scope="col">${t("setup.audit.detail")}</th></tr>
      ${entries.map((entry) => html`<tr key=${entry.number}>
        <td class="time">${clockTime(entry.time_utc)}</td>
        <td class="long">${[entry.client, entry.who, entry.peer].filter(Boolean).join(", ")}</td>
        <td>${entry.what}</td>
        <td>${entry.outcome}</td>
        <td class="long">${entry.detail}</td>
      </tr>`)}
    </table></div>
    <p class="buttons">
      <button type="button" disabled=${running} onClick=${() => fetchPage([])}>${t("setup.audit.again")}</button>
      ${!isAll && entries.length > 0 && html`<button type="button" disabled=${running} onClick=${() => fetchPage(entries)}>${t("setup.audit.more")}</button>`}
    </p>
  </section>`;
}
