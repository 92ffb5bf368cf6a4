// Goes through all pages in all states, light and dark, in both languages: examines and photographs each.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { axe, overflow, smallTargets } from "./examine.mjs";
import { shots } from "./paths.mjs";
import { statesOf } from "./states.mjs";
import { openTab, settled, visit } from "./tab.mjs";

const kSmall = { width: 640, height: 512 };  // 1280 x 1024 at 200 % zoom

async function inState(tab, station, state) {
  if (state.cut) await tab.page.route("**/api/v1/events", (route) => route.abort());
  await visit(tab.page, station, state.path, { isOnline: !state.cut });
  if (state.prepare) {
    await state.prepare(tab.page, station);
    await settled(tab.page);
  }
}

async function examine(tab, name, sums) {
  const counts = await axe(tab.page, name);
  sums.axe_serious += counts.serious;
  sums.axe_moderate += counts.moderate;
  sums.axe_minor += counts.minor;
  sums.small_targets += await smallTargets(tab.page, name);
  await tab.page.evaluate(() => scrollTo(0, 0));
  await tab.page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
}

// only: part of a state's name; empty = all. isQuick: one language and one theme.
export async function walk(browser, station, figures, about, { only = "", isQuick = false } = {}) {
  mkdirSync(shots, { recursive: true });
  const sums = { states_checked: 0, states_failed: 0, axe_serious: 0, axe_moderate: 0, axe_minor: 0, small_targets: 0, zoom200_overflow: 0 };
  const states = statesOf(about).filter(({ name }) => name.includes(only));
  for (const language of isQuick ? ["de"] : ["en", "de"]) {
    for (const theme of isQuick ? ["light"] : ["light", "dark"]) {
      for (const state of states) {
        const name = `${state.name}-${theme}-${language}`;
        const token = state.token === undefined ? station.token : state.token;
        const tab = await openTab(browser, station, figures, { language, theme, token, mayFail: state.mayFail ?? false });
        try {
          await inState(tab, station, state);
          await examine(tab, name, sums);
          // The layout is the theme's neither way: once a language.
          if (theme === "light") {
            await tab.page.setViewportSize(kSmall);
            await settled(tab.page);
            sums.zoom200_overflow += await overflow(tab.page, name);
            await tab.page.screenshot({ path: join(shots, `${name}-640.png`), fullPage: true });
          }
          ++sums.states_checked;
          console.error(`looked at ${name}`);
        } catch (error) {
          ++sums.states_failed;
          console.error(`state ${name}: ${error.message.split("\n").slice(0, 6).join("\n  ")}`);
        } finally {
          if (state.after) await state.after(tab.page, station).catch((error) => console.error(`after ${name}: ${error.message}`));
          await tab.close();
        }
      }
    }
  }
  return sums;
}
