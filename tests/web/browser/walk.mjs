// Goes through all pages in all states, light and dark, in both languages: examines each, and photographs what is kept.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { axe, onPaper, overflow, smallTargets } from "./examine.mjs";
import { shots } from "./paths.mjs";
import { pictureOf } from "./shots.mjs";
import { statesOf } from "./states.mjs";
import { openTab, settled, visit } from "./tab.mjs";

const kSmall = { width: 640, height: 512 };  // 1280 x 1024 at 200 % zoom
const kPicture = { width: 1280, height: 800 };
const kA4 = { width: 794, height: 1123 };  // at 96 dpi

async function inState(tab, station, state) {
  if (state.cut) await tab.page.route("**/api/v1/events", (route) => route.abort());
  await visit(tab.page, station, state.path, { isOnline: !state.cut });
  if (state.prepare) {
    await state.prepare(tab.page, station);
    await settled(tab.page);
  }
  if (state.isPaper) {
    await tab.page.setViewportSize(kA4);
    await tab.page.emulateMedia({ media: "print" });
    await settled(tab.page);
  }
}

async function examine(tab, name, state, sums) {
  if (state.isPaper) {
    sums.wrong_on_paper += await onPaper(tab.page, name);
    return;
  }
  const counts = await axe(tab.page, name);
  sums.axe_serious += counts.serious;
  sums.axe_moderate += counts.moderate;
  sums.axe_minor += counts.minor;
  sums.small_targets += await smallTargets(tab.page, name);
}

async function photograph({ page }, state, file, viewport) {
  if (!state.isPaper) await page.setViewportSize(state.viewport ?? viewport);
  await settled(page);
  // Below the bar on top, which the page keeps free.
  await page.evaluate((at) => (at ? document.querySelector(at)?.scrollIntoView({ block: "start", behavior: "instant" }) : scrollTo(0, 0)), state.at ?? "");
  await settled(page);
  await page.screenshot({ path: `${file}.png`, animations: "disabled", fullPage: state.isPaper ?? false });
}

// What of a state is photographed, and where: kept ones by their name, all of them with both words.
function filesOf(state, about, all) {
  const kept = pictureOf(state, about);
  const words = [state.name, about.theme, about.language, about.isNarrow ? "640" : ""].filter(Boolean).join("-");
  return [...(kept ? [join(shots, kept)] : []), ...(all ? [join(shots, "all", words)] : [])];
}

const tokenOf = ({ token }, station) => (token === undefined ? station.token : token === "operator" ? station.operator : token);

async function lookAt(browser, station, figures, state, { language, theme, all, sums }) {
  const name = `${state.name}-${theme}-${language}`;
  let tab = null;
  try {
    await state.before?.(station);
    const { viewport, scale, clock_ms, mayFail = false } = state;
    tab = await openTab(browser, station, figures, {
      language, theme, token: tokenOf(state, station), mayFail, viewport, scale, clock_ms,
      mayWarn: /GPU stall due to ReadPixels/,  // it is the photograph that reads
    });
    await inState(tab, station, state);
    await examine(tab, name, state, sums);
    for (const file of filesOf(state, { language, theme }, all)) await photograph(tab, state, file, kPicture);
    // The layout is the theme's neither way: once a language.
    if (theme === "light" && !state.isPaper && !state.viewport) {
      await tab.page.setViewportSize(kSmall);
      await settled(tab.page);
      sums.zoom200_overflow += await overflow(tab.page, name);
      for (const file of filesOf(state, { language, theme, isNarrow: true }, all)) await photograph(tab, state, file, kSmall);
    }
    ++sums.states_checked;
    console.error(`looked at ${name}`);
  } catch (error) {
    ++sums.states_failed;
    console.error(`state ${name}: ${error.message.split("\n").slice(0, 6).join("\n  ")}`);
  } finally {
    await Promise.resolve(state.after?.(tab?.page, station)).catch((error) => console.error(`after ${name}: ${error.message}`));
    await tab?.close();
  }
}

// only: part of a state's name; empty = all. isQuick: one language and one theme. all: pictures of whatever is looked at.
export async function walk(browser, station, figures, about, { only = "", isQuick = false, all = false } = {}) {
  mkdirSync(join(shots, all ? "all" : "."), { recursive: true });
  const sums = { states_checked: 0, states_failed: 0, axe_serious: 0, axe_moderate: 0, axe_minor: 0, small_targets: 0, zoom200_overflow: 0, wrong_on_paper: 0 };
  const states = statesOf(about).filter(({ name }) => name.includes(only));
  for (const language of isQuick ? ["de"] : ["en", "de"]) {
    for (const theme of isQuick ? ["light"] : ["light", "dark"]) {
      for (const state of states) await lookAt(browser, station, figures, state, { language, theme, all, sums });
    }
  }
  return sums;
}
