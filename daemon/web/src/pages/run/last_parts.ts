// The last 20 parts, the newest first, with their verdicts.
import { useEffect, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, resyncs, results, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { VerdictMark, verdictWord } from "../../parts/verdict_mark.ts";
import type { JobRow } from "../../rpc/listed.ts";
import { look } from "../../rpc/look.ts";
import { recentRecipes } from "./run_state.ts";

const kMost = 20;

interface Strip {
  isTold: boolean;
  parts: readonly JobRow[];
  problem: string;
}

function useStrip(): Strip {
  const { job } = useStore(topics);
  const { count: newResults } = useStore(results);
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  const [strip, setStrip] = useState<Strip>({ isTold: false, parts: [], problem: "" });
  const ended = job?.done ? job.job_id : "";
  useEffect(() => {
    if (!isLinked) return;
    let isOver = false;
    // One more than is shown: the newest may be running yet.
    look("job.list", { most: kMost + 1 }).then(({ jobs }) => {
      const parts = jobs.filter(({ state }) => state !== "processing").slice(0, kMost);
      if (isOver) return;
      setStrip({ isTold: true, parts, problem: "" });
      recentRecipes.set(parts.map(({ recipe }) => recipe));
    }, (error: unknown) => {
      if (!isOver) setStrip((before) => ({ ...before, problem: messageOf(error) }));
    });
    return () => {
      isOver = true;
    };
  }, [ended, newResults, count, isLinked]);
  return strip;
}

function Part({ part }: { part: JobRow }) {
  const word = part.state === "completed" ? verdictWord(part.verdict) : tWord("run.job_state", part.state);
  return html`<li><a class=${`part part-${part.state}`} href=${`/jobs/${encodeURIComponent(part.job_id)}`} title=${part.part_id}>
    ${part.state === "completed" ? html`<${VerdictMark} verdict=${part.verdict} size=${24}/>` : html`<span class="part-no-result" aria-hidden="true">∅</span>`}
    <bdi class="part-id">${part.part_id}</bdi> <span class="part-word">${word}</span>
  </a></li>`;
}

export function LastParts() {
  useLanguage();
  const { isTold, parts, problem } = useStrip();
  return html`<section class="panel last" aria-labelledby="last-title">
    <h2 id="last-title">${t("run.last_parts")}</h2>
    ${isTold && parts.length === 0 && html`<p class="help">${t("run.no_parts")}</p>`}
    ${parts.length > 0 && html`<ol class="strip" tabindex="0" aria-labelledby="last-title">${parts.map((part) => html`<${Part} key=${part.job_id} part=${part}/>`)}</ol>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
  </section>`;
}
