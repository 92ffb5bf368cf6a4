// A job without a pointer, and jogs that end with the hand or the page.
import { jogEnds } from "../../web/browser/jog_ends.mjs";
import { keyboardJob } from "../../web/browser/keyboard_job.mjs";
import { Motions } from "./motions.mjs";
import { phase } from "./phase.mjs";

const kSpeed_um_per_s = 100;  // the page begins with one that the simulator counts as standstill

await phase(async ({ browser, station, figures }) => {
  const keyboard_only_job = await keyboardJob(browser, station, figures);
  const motions = new Motions(station.motions);
  const jog_halt_ms = await jogEnds(browser, station, figures, { speed_um_per_s: kSpeed_um_per_s, standstill: (since_ms) => motions.awaitLine("still", since_ms) });
  motions.close();
  if (jog_halt_ms === null) throw new Error("a jog did not end");
  return { keyboard_only_job, jog_halt_ms };
});
