// The operator page in a browser, against the daemon and a simulated station. The last line is one JSON object.
//
// node tests/web/browser/run.mjs [--only STATE] [--quick] [--all-shots] [--no-walk] [--no-jog] [--no-keys]
// --quick walks in German and light only; --all-shots photographs whatever is looked at into tests/web/shots/all.
// FVD_BUILD: a build with fvd, fvdctl and fvd-sim (default build); FVD_CHROMIUM: the browser (default /usr/bin/chromium).
import { firstView } from "./first_view.mjs";
import { jogEnds } from "./jog_ends.mjs";
import { keyboardJob } from "./keyboard_job.mjs";
import { openBrowser } from "./launch.mjs";
import { makeOddResults, oddRecipes } from "./odd_results.mjs";
import { untranslated } from "./paths.mjs";
import { scan, startStation } from "./station.mjs";
import { newFigures } from "./tab.mjs";
import { walk } from "./walk.mjs";

const has = (option) => process.argv.includes(option);
const at = process.argv.indexOf("--only");
const only = at < 0 ? "" : process.argv[at + 1] ?? "";

// What must hold; what was not looked at is not judged.
const kBounds = {
  console_errors: 0, csp_violations: 0, third_party_requests: 0, moves_without_press: 0, states_failed: 0,
  axe_serious: 0, axe_moderate: 0, zoom200_overflow: 0, wrong_on_paper: 0, untranslated: 0, small_targets: 0, requests_first_view: 8, bundle_gz_kib: 80,
};

const recipe = "groove";
const figures = { ...newFigures(), untranslated };
const station = await startStation({ recipes: oddRecipes() });
let browser;
try {
  browser = await openBrowser();
  // A station that runs already has no recipes of ours.
  const odd = process.env.FVD_PAGE_URL ? undefined : await makeOddResults(station.call, recipe);
  const jobs = await scan(station.call, { recipe, parts: 2 });
  await station.call("verify.noise", { jobs });
  Object.assign(figures, await firstView(browser, station, figures));
  if (!has("--no-walk")) Object.assign(figures, await walk(browser, station, figures, { jobs, recipe, odd }, { only, isQuick: has("--quick"), all: has("--all-shots") }));
  if (!has("--no-jog")) figures.jog_halt_ms = await jogEnds(browser, station, figures);
  if (!has("--no-keys")) figures.keyboard_only_job = await keyboardJob(browser, station, figures, recipe);
} catch (error) {
  figures.ended_early = String(error.message).split("\n")[0];
} finally {
  await browser?.close();
  await station.stop();
}
const missed = Object.entries(kBounds).filter(([name, bound]) => name in figures && figures[name] > bound).map(([name]) => name);
if (figures.keyboard_only_job === false) missed.push("keyboard_only_job");
if (figures.ended_early) missed.push("ended_early");
if (figures.jog_halt_ms === null) missed.push("jog_halt_ms");
console.log(JSON.stringify({ ...figures, missed }));
process.exitCode = missed.length > 0 ? 1 : 0;
