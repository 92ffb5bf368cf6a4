// The last 20 parts, the newest first, with their verdicts.
import { useEffect, useRef, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, resyncs, results, topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { VerdictMark, verdictWord } from "../../parts/verdict_mark.ts";
import { RpcError } from "../../rpc/rpc.ts";
import { type LastPart, withPart } from "../../run/last_parts.ts";
import { verdictOf } from "../../run/value_rows.ts";
import { listJobs } from "./to_come.ts";

const kMost = 20;
const kNoSuchMethod = -32601;

interface Strip {
  isTold: boolean;
  parts: readonly LastPart[];
  isSeenOnly: boolean;  // fvd lists no jobs: these are those that this page has seen end
  problem: string;
}

function useStrip(): Strip {
  const { job } = useStore(topics);
  const { count: newResults } = useStore(results);
  const count = useStore(resyncs);
  const isLinked = useStore(link).status === "open";
  const seen = useRef<readonly LastPart[]>([]);
  const [strip, setStrip] = useState<Strip>({ isTold: false, parts: [], isSeenOnly: false, problem: "" });
  const ended = job?.done ? job.job_id : "";
  if (job?.done) {
    seen.current = withPart(seen.current, { job_id: job.job_id, part_id: job.part_id, state: job.state, verdict: verdictOf(job.evaluation) }, kMost);
  }
  useEffect(() => {
    if (!isLinked) return;
    let isOver = false;
    listJobs(kMost).then(({ jobs }) => {
      const parts = jobs.filter(({ state }) => state !== "processing")
        .map(({ job_id, part_id, state, verdict }) => ({ job_id, part_id, state, verdict: verdictOf(verdict) }));
      if (!isOver) setStrip({ isTold: true, parts, isSeenOnly: false, problem: "" });
    }, (error: unknown) => {
      if (isOver) return;
      const isUnknown = error instanceof RpcError && error.code === kNoSuchMethod;
      setStrip((before) => ({ isTold: isUnknown, parts: isUnknown ? seen.current : before.parts, isSeenOnly: isUnknown, problem: isUnknown ? "" : messageOf(error) }));
    });
    return () => {
      isOver = true;
    };
  }, [ended, newResults, count, isLinked]);
  return strip;
}

function Part({ part }: { part: LastPart }) {
  const word = part.state === "completed" ? verdictWord(part.verdict) : tWord("run.job_state", part.state);
  return html`<li><a class=${`part part-${part.state}`} href=${`/jobs/${encodeURIComponent(part.job_id)}`} title=${part.part_id}>
    ${part.state === "completed" ? html`<${VerdictMark} verdict=${part.verdict} size=${24}/>` : html`<span class="part-no-result" aria-hidden="true">∅</span>`}
    <bdi class="part-id">${part.part_id}</bdi> <span class="part-word">${word}</span>
  </a></li>`;
}

export function LastParts() {
  useLanguage();
  const { isTold, parts, isSeenOnly, problem } = useStrip();
  return html`<section class="panel last" aria-labelledby="last-title">
    <h2 id="last-title">${t("run.last_parts")}</h2>
    ${isTold && parts.length === 0 && html`<p class="help">${t("run.no_parts")}</p>`}
    ${parts.length > 0 && html`<ol class="strip" tabindex="0" aria-labelledby="last-title">${parts.map((part) => html`<${Part} key=${part.job_id} part=${part}/>`)}</ol>`}
    ${isSeenOnly && html`<p class="help">${t("run.seen_only")}</p>`}
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
  </section>`;
}
