// What was measured: the list of jobs, one value over time, two jobs beside each other.
import { useEffect, useRef, useState } from "preact/hooks";
import { t, useLanguage } from "../../i18n/i18n.ts";
import { addressOf, filterOf, wantedOf } from "../../history/filter.ts";
import { html } from "../../lib/html.ts";
import { go, place } from "../../lib/router.ts";
import { useStore } from "../../lib/store.ts";
import { results } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import type { JobRow } from "../../rpc/listed.ts";
import { call } from "../../rpc/rpc.ts";
import { Comparison } from "./comparison.ts";
import { FilterForm } from "./filter_form.ts";
import { JobTable } from "./job_table.ts";
import { RunChart } from "./run_chart.ts";
import "../../style/history.css";

const kPage = 50;

function History() {
  const { query } = useStore(place);
  const { count } = useStore(results);
  const wanted = wantedOf(query);
  const [rows, setRows] = useState<JobRow[]>([]);
  const [next, setNext] = useState("");
  const [problem, setProblem] = useState("");
  const [busy, setBusy] = useState(true);
  const [chosen, setChosen] = useState<string[]>([]);
  const asked = useRef<AbortController | null>(null);

  const load = async (before: string): Promise<void> => {
    asked.current?.abort();
    const mine = new AbortController();
    asked.current = mine;
    setBusy(true);
    try {
      const page = await call("job.list", { ...filterOf(wanted), most: kPage, ...(before ? { before } : {}) }, { signal: mine.signal });
      if (asked.current !== mine) return;
      setRows((was) => (before ? [...was, ...page.jobs] : page.jobs));
      setNext(page.next);
      setProblem("");
    } catch (error) {
      if (asked.current !== mine) return;
      setProblem(messageOf(error));
    }
    setBusy(false);
  };
  // A result that comes while one reads an older page must not throw the reader back to the first.
  const first = rows.length <= kPage;
  const sought = JSON.stringify(filterOf(wanted));
  useEffect(() => void load(""), [sought]);
  useEffect(() => {
    if (count > 0 && first) void load("");
  }, [count]);
  useEffect(() => () => asked.current?.abort(), []);

  const choose = (job_id: string): void =>
    setChosen((was) => (was.includes(job_id) ? was.filter((each) => each !== job_id) : [...was, job_id].slice(-2)));
  return html`<h1>${t("nav.history")}</h1>
    <${FilterForm} wanted=${wanted} onChange=${(to: typeof wanted) => go(addressOf(to), { replace: true })}/>
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    <${JobTable} rows=${rows} chosen=${chosen} onChoose=${choose}/>
    <p aria-live="polite" class="help">${busy ? t("history.loading") : t(next ? "history.shown_more" : "history.shown", { count: rows.length })}</p>
    ${next && html`<p class="buttons"><button type="button" disabled=${busy} onClick=${() => void load(next)}>${t("history.more")}</button></p>`}
    <${RunChart} rows=${rows} recipe=${wanted.recipe}/>`;
}

export function HistoryPage() {
  useLanguage();
  const { query } = useStore(place);
  const pair = (query.get("compare") ?? "").split(",");
  const [a, b] = pair;
  if (pair.length === 2 && a && b) return html`<${Comparison} key=${pair.join()} first=${a} second=${b}/>`;
  return html`<${History}/>`;
}
