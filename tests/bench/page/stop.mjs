// From F10 to the stop at the stage, at any moment of a scan in one motion.
//
// node stop.mjs : FVD_PAGE_ROUNDS (100) stops.
import { until } from "../../web/browser/wait.mjs";
import { percentile, rounded, told } from "./clock.mjs";
import { Motions } from "./motions.mjs";
import { phase, rounds } from "./phase.mjs";
import { generator } from "./random.mjs";
import { RunPageTab } from "./run_page_tab.mjs";

const kLong = {
  format: 2,
  description: "A scan in one motion that is stopped",
  acquire: {
    scan: { mode: "continuous", start_um: -200, step_um: 2, slices: 201, speed_um_per_s: 200, allowed_lost_slices: 190 },
    camera: { pixel_format: "Mono8", exposure_us: 1000, width_px: 96, height_px: 64 },
  },
  reconstruct: { focus: { window_px: 9, distance_px: 1 }, lateral: { pixel_pitch_x_um: 1, pixel_pitch_y_um: 1 } },
};

await phase(async ({ browser, station, figures }) => {
  const motions = new Motions(station.motions);
  const tab = await RunPageTab.open(browser, station, figures);
  const pick = generator(1);
  await station.call("stage.home");
  const stop_ms = [];
  for (let i = 0; i < rounds(100); ++i) {
    const part = `stop-${i}`;
    await until("ready", async () => (await station.call("system.state")).ready);
    await tab.choose(part, "long");
    const pressed_ms = await tab.press("F9");
    await motions.awaitLine("moving", pressed_ms);
    const { job_id } = await tab.jobOf(part);
    await new Promise((wake) => setTimeout(wake, 1000 * pick()));  // into the travel, or the scan
    const stopped_ms = await tab.press("F10");
    stop_ms.push(await motions.awaitLine("stop", stopped_ms) - stopped_ms);
    const { state } = await station.call("job.wait", { job_id });
    if (state === "completed") throw new Error(`job ${job_id} went on after the stop`);
  }
  await tab.close();
  motions.close();
  told("stop to stage", stop_ms);
  return { stop_to_stage_ms: rounded(percentile(stop_ms, 0.99)), stops: stop_ms.length };
}, { recipes: { long: kLong } });
