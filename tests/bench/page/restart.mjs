// A page that stays open while the daemon is killed, comes back and measures: it says so, resumes by itself, and shows
// what the daemon knows.
import { openTab, visit } from "../../web/browser/tab.mjs";
import { until } from "../../web/browser/wait.mjs";
import { now_ms } from "./clock.mjs";
import { phase, rounds } from "./phase.mjs";

const kPatience_ms = 15000;  // for the page to know what the daemon knows
const recipe = "groove";

async function start({ call }, part_id) {
  await until("ready", async () => (await call("system.state")).ready);
  const { newest_seq } = await call("job.latest", { client: "harness" });
  return (await call("job.start", { client: "harness", seq: newest_seq + 1, part_id, recipe })).job_id;
}

const ended = ({ call }, job_id) => call("job.wait", { job_id });

// What the page shows of the daemon's state and results.
const shown = (page) => page.evaluate(() => ({
  state: document.querySelector(".banner")?.className.match(/banner-(\w+)/)?.[1],
  parts: [...document.querySelectorAll(".last .strip a")].map((link) => decodeURIComponent(link.pathname.split("/").pop())),
  newest: document.querySelector("section.map h2 .part-id")?.textContent ?? "",
  isOffline: document.querySelector("header .link") !== null,
}));

async function differences({ call }, page) {
  const [{ state }, { jobs }] = [await call("system.state"), await call("job.list", { most: 20 })];
  const done = jobs.filter((job) => job.state !== "processing");
  const there = await shown(page);
  const missing = done.filter(({ job_id }) => !there.parts.includes(job_id)).map(({ job_id }) => job_id);
  if (there.newest !== done[0].part_id) missing.push(`the newest, ${done[0].part_id}, in the place of ${there.newest}`);
  return { missing, state: there.isOffline || there.state !== state ? `${there.state} for ${state}` : "" };
}

await phase(async ({ browser, station, figures }) => {
  const { page, close } = await openTab(browser, station, figures, { token: station.operator, mayFail: true });
  await visit(page, station, "/");
  await page.evaluate(() => void (window.fvdStays = true));
  await ended(station, await start(station, "before"));
  const sums = { results_missing_after_restart: 0, page_differs_after_restart: 0, restart_banner_ms: 0, reloads: 0, restarts: 0 };
  for (let i = 0; i < rounds(10); ++i) {
    const cut = await start(station, `cut-${i}`);
    if (i % 2 === 0) await ended(station, cut);  // else the daemon is killed while it measures
    const killed_ms = now_ms();
    await station.restart({
      signal: "SIGKILL",
      between: async () => {
        await page.locator("header .link").waitFor();
        sums.restart_banner_ms = Math.max(sums.restart_banner_ms, Math.round(now_ms() - killed_ms));
      },
    });
    const after = await start(station, `after-${i}`);  // the page may not be back yet
    await ended(station, after);
    let last;
    await until("the page knows what the daemon knows", async () => {
      last = await differences(station, page);
      return last.missing.length === 0 && last.state === "";
    }, kPatience_ms).catch(() => console.error(`after restart ${i}: missing ${last.missing.join(", ")}; state ${last.state}`));
    sums.results_missing_after_restart += last.missing.length;
    sums.page_differs_after_restart += last.state === "" ? 0 : 1;
    sums.reloads += await page.evaluate(() => window.fvdStays === true) ? 0 : 1;
    ++sums.restarts;
    await station.call("result.ack", { job_id: after });
  }
  await close();
  return sums;
});
