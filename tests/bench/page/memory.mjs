// How much a tab with the run page grows over 500 jobs: memory of the browser's page processes that is theirs alone, and
// the scripts' heap, both after a collection.
import { readFileSync } from "node:fs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { until } from "../../web/browser/wait.mjs";
import { rounded } from "./clock.mjs";
import { phase, rounds } from "./phase.mjs";

const kWarm = 50;   // jobs before: caches fill, code is compiled
const kRecipe = {
  format: 2,
  description: "As short as a job can be",
  acquire: { scan: { start_um: -7, step_um: 10, slices: 9 }, camera: { pixel_format: "Mono8", exposure_us: 1000, width_px: 96, height_px: 64 } },
  reconstruct: { focus: { window_px: 9, distance_px: 1, min_prominence: 0.5 }, lateral: { pixel_pitch_x_um: 1, pixel_pitch_y_um: 1 } },
};

async function memoryOf(browser, page) {
  const devtools = await page.context().newCDPSession(page);
  const whole = await browser.newBrowserCDPSession();
  try {
    for (let i = 0; i < 3; ++i) await devtools.send("HeapProfiler.collectGarbage");
    await devtools.send("Performance.enable");
    const { metrics } = await devtools.send("Performance.getMetrics");
    const { processInfo } = await whole.send("SystemInfo.getProcessInfo");
    const kib = processInfo.filter(({ type }) => type === "renderer").reduce((sum, { id }) => sum + privateKib(id), 0);
    return { own_mib: kib / 1024, heap_mib: metrics.find(({ name }) => name === "JSHeapUsedSize").value / 2 ** 20 };
  } finally {
    await devtools.detach();
    await whole.detach();
  }
}

const privateKib = (pid) => [...readFileSync(`/proc/${pid}/smaps_rollup`, "utf8").matchAll(/^Private_\w+:\s+(\d+) kB/gm)].reduce((sum, [, kib]) => sum + Number(kib), 0);

async function runJob({ call }, seq) {
  const part_id = `memory-${seq}`;
  await until("ready", async () => (await call("system.state")).ready);
  const { job_id } = await call("job.start", { client: "harness", seq, part_id, recipe: "short" });
  const { state } = await call("job.wait", { job_id });
  if (state !== "completed") throw new Error(`job ${job_id} is ${state}`);
  await call("result.ack", { job_id });
  return part_id;
}

await phase(async ({ browser, station, figures }) => {
  const { page, close } = await openTab(browser, station, figures, { token: station.operator });
  await visit(page, station, "/");
  const jobs = rounds(500);
  let begun = null;
  for (let seq = 1; seq <= kWarm + jobs; ++seq) {
    const part = await runJob(station, seq);
    // Each is shown: else nothing would be kept that could pile up. What tells so is no element: a handle would keep it.
    await page.waitForFunction((wanted) => document.querySelector("section.map h2 .part-id")?.textContent === wanted && document.querySelector(".height-map canvas") !== null, part);
    if (seq === kWarm) begun = await memoryOf(browser, page);
    if (seq % 100 === 0) console.error(`${seq} jobs: ${JSON.stringify(await memoryOf(browser, page))}`);
  }
  const ended = await memoryOf(browser, page);
  await close();
  return { tab_memory_growth_mib: rounded(ended.own_mib - begun.own_mib), tab_heap_growth_mib: rounded(ended.heap_mib - begun.heap_mib), tab_jobs: jobs };
}, { recipes: { short: kRecipe } });
