// What the machine is doing, in a word that is read from three metres.
import { t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { VerdictLabel, verdictWord } from "../../parts/verdict_mark.ts";
import { verdictOf } from "../../run/value_rows.ts";
import { whatToDo } from "./what_to_do.ts";

const kIcons: Record<string, string> = {
  unknown: "M12 2a10 10 0 1 0 0 20 10 10 0 0 0 0-20Zm0 3a7 7 0 1 1 0 14 7 7 0 0 1 0-14Z",
  preoperational: "M6 2h12v5l-4 5 4 5v5H6v-5l4-5-4-5Z",
  initialized: "M12 2 22 12 12 22 2 12Zm0 4-6 6 6 6 6-6Z",
  ready: "M7 3v18l14-9Z",
  executing: "M12 2a10 10 0 1 1-10 10h4a6 6 0 1 0 6-6Z",
  error: "M12 2 23 21H1Zm-1.3 6v7h2.6V8Zm0 8.5V19h2.6v-2.5Z",
  halted: "M4 4h16v16H4Z",
};

function sentence(state: string): string {
  const { job, state: machine } = topics.get();
  if (state !== "executing") return tWord("run.state_says", state);
  if (!job || job.done) return t("run.says_moving");
  if (job.acquired || machine?.part_release) return t("run.says_part_free");
  return t(machine?.acquiring ? "run.says_hands_off" : "run.says_preparing");
}

export function StateBanner() {
  useLanguage();
  const { state, job } = useStore(topics);
  const isLinked = useStore(link).status === "open";
  const word = isLinked && state ? state.state : "unknown";
  const verdict = verdictOf(job?.evaluation);
  const isJudged = isLinked && word !== "executing" && job?.done === true && job.state === "completed";
  return html`<section class=${`banner banner-${word}`} aria-label=${t("run.state_label")}>
    <svg class="banner-icon" width="56" height="56" viewBox="0 0 24 24" fill="currentColor" fill-rule="evenodd" aria-hidden="true"><path d=${kIcons[word] ?? kIcons["unknown"]}/></svg>
    <div class="banner-text" aria-live="polite">
      <p class="banner-word">${tWord("run.state", word)}</p>
      <p class="banner-says">${sentence(word)}</p>
      ${isJudged && html`<p class="hidden">${t("run.part_verdict", { part: job.part_id, verdict: verdictWord(verdict) })}</p>`}
    </div>
    ${isJudged && html`<p class="banner-verdict" aria-hidden="true"><bdi class="part-id">${job.part_id}</bdi><${VerdictLabel} verdict=${verdict} size=${40}/></p>`}
    ${isLinked && word === "error" && html`<div class="banner-fault" role="alert">
      <p><strong>${state?.error_message}</strong> <span class="code">${state?.error_code} ${state?.error}</span></p>
      <p>${whatToDo(state?.error_code ?? 0)}</p>
    </div>`}
  </section>`;
}
