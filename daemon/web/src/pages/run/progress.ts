// How far the job is: slices, z, seconds left, frames.
import { useEffect, useRef } from "preact/hooks";
import { number, t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { pictured } from "../../run/preview_poll.ts";
import { type Mark, marked, plannedZ_um, secondsLeft } from "../../run/time_left.ts";
import { useRecipe } from "./use_recipe.ts";

const kFresh_ms = 1500;

function useSecondsLeft(): number | null {
  const { job } = useStore(topics);
  const held = useRef<{ job_id: string; marks: readonly Mark[] }>({ job_id: "", marks: [] });
  const id = job && !job.done ? job.job_id : "";
  useEffect(() => {
    held.current = { job_id: id, marks: [] };
  }, [id]);
  if (!job || id === "" || held.current.job_id !== id) return null;
  held.current.marks = marked(held.current.marks, performance.now(), job.slices_done);
  return secondsLeft(held.current.marks, job.slices_planned);
}

export function Progress() {
  useLanguage();
  const { job } = useStore(topics);
  const picture = useStore(pictured);
  const left_s = useSecondsLeft();
  const recipe = useRecipe(job && !job.done ? job.recipe : "") as { acquire?: { scan?: unknown } } | null;
  if (!job || job.done) {
    return html`<section class="panel progress" aria-labelledby="progress-title">
      <h2 id="progress-title">${t("run.progress")}</h2>
      <p class="help">${t("run.nothing_runs")}</p>
    </section>`;
  }
  const isFresh = picture !== null && performance.now() - picture.at_ms < kFresh_ms;
  const z_um = isFresh ? picture.z_um : plannedZ_um(recipe?.acquire?.scan, job.slices_done);
  const lost = job.frames_expected - job.frames_ok;
  return html`<section class="panel progress" aria-labelledby="progress-title">
    <h2 id="progress-title">${t("run.progress_of")} <bdi class="part-id">${job.part_id}</bdi></h2>
    <p>${tWord("run.phase", job.phase)}</p>
    <progress max=${Math.max(1, job.slices_planned)} value=${job.slices_done} aria-label=${t("run.progress")}></progress>
    <dl class="figures">
      <dt>${t("run.slice")}</dt><dd>${t("run.slice_of", { done: job.slices_done, planned: job.slices_planned })}</dd>
      <dt>z</dt><dd>${z_um === null ? "–" : `${number(z_um, 1)} µm${isFresh ? "" : ` ${t("run.z_planned")}`}`}</dd>
      <dt>${t("run.time_left")}</dt><dd>${left_s === null ? "–" : t("run.seconds", { seconds: number(left_s, left_s < 10 ? 1 : 0) })}</dd>
      <dt>${t("run.frames")}</dt><dd class=${lost > 0 ? "problem" : undefined}>${t("run.frames_of", { ok: job.frames_ok, lost: Math.max(0, lost) })}</dd>
    </dl>
  </section>`;
}
