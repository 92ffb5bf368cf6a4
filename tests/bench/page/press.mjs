// From F9 to the stage's first command, beside the same by a call; from the valid result to the screen.
//
// node press.mjs : a job of each kind in turn, FVD_PAGE_ROUNDS (100) of them.
import { until } from "../../web/browser/wait.mjs";
import { now_ms, percentile, rounded, told } from "./clock.mjs";
import { Motions } from "./motions.mjs";
import { phase, rounds } from "./phase.mjs";
import { RunPageTab } from "./run_page_tab.mjs";

const recipe = "groove";

const isReady = (station) => until("ready", async () => (await station.call("system.state")).ready);

// job.wait ends within 30 s; a job of this recipe does, too.
async function endOf(station, job_id) {
  const { done, state } = await station.call("job.wait", { job_id });
  const at_ms = now_ms();
  if (!done || state !== "completed") throw new Error(`job ${job_id} is ${state}`);
  return at_ms;
}

async function byPage(tab, station, motions, part) {
  await isReady(station);
  await tab.choose(part, recipe);
  const shown = tab.shownAt(part);
  shown.catch(() => undefined);  // where something else fails before it is awaited
  const pressed_ms = await tab.press("F9");
  const moved_ms = await motions.awaitLine("move", pressed_ms);
  const { job_id } = await tab.jobOf(part);
  const valid_ms = await endOf(station, job_id);
  return { stage_ms: moved_ms - pressed_ms, screen_ms: await shown - valid_ms };
}

// Ends when the page shows it: what presses next has seen what was before, and waits for none of it.
async function byCall(tab, station, motions, seq) {
  const part_id = `call-${seq}`;
  await isReady(station);
  const sent_ms = now_ms();
  const { job_id } = await station.call("job.start", { client: "harness", seq, part_id, recipe });
  const moved_ms = await motions.awaitLine("move", sent_ms);
  await endOf(station, job_id);
  await station.call("result.ack", { job_id });
  await tab.shownAt(part_id);
  return moved_ms - sent_ms;
}

await phase(async ({ browser, station, figures }) => {
  const motions = new Motions(station.motions);
  const tab = await RunPageTab.open(browser, station, figures);
  const page_ms = [];
  const call_ms = [];
  const screen_ms = [];
  await byCall(tab, station, motions, 1);  // the first one homes
  await byPage(tab, station, motions, "press-0");
  for (let i = 1; i <= rounds(100); ++i) {
    const measured = await byPage(tab, station, motions, `press-${i}`);
    page_ms.push(measured.stage_ms);
    screen_ms.push(measured.screen_ms);
    call_ms.push(await byCall(tab, station, motions, i + 1));
  }
  await tab.close();
  motions.close();
  told("press to stage", page_ms);
  told("call to stage", call_ms);
  told("valid result to screen", screen_ms);
  const [press, call] = [percentile(page_ms, 0.99), percentile(call_ms, 0.99)];
  return {
    press_to_stage_ms: rounded(press), call_to_stage_ms: rounded(call), press_over_call_ms: rounded(press - call),
    result_to_screen_ms: rounded(percentile(screen_ms, 0.99)), presses: page_ms.length,
  };
});
