// A job without a pointer, and jogs that end with the hand or the page.
import { jogEnds } from "../../web/browser/jog_ends.mjs";
import { keyboardJob } from "../../web/browser/keyboard_job.mjs";
import { phase } from "./phase.mjs";

await phase(async ({ browser, station, figures }) => {
  const keyboard_only_job = await keyboardJob(browser, station, figures);
  const jog_halt_ms = await jogEnds(browser, station, figures);
  if (jog_halt_ms === null) throw new Error("a jog did not end");
  return { keyboard_only_job, jog_halt_ms };
});
