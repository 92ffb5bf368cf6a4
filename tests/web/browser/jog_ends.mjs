// A jog ends with the hand and with the page: how long the stage still moves after each way to leave.
import { methodOf, openTab, visit } from "./tab.mjs";
import { now_ms, until } from "./wait.mjs";

const kWays = {
  "key up": { hold: (page) => page.keyboard.down("Space"), leave: (page) => page.keyboard.up("Space") },
  "pointer up": { hold: (page) => page.mouse.down(), leave: (page) => page.mouse.up() },
  "another page": { hold: (page) => page.mouse.down(), leave: (page) => page.evaluate(() => history.back()) },
  "blur": { hold: (page) => page.mouse.down(), leave: (page) => page.evaluate(() => void window.dispatchEvent(new Event("blur"))) },
  "closed": { hold: (page) => page.keyboard.down("Space"), leave: (page) => page.close() },
  "gone elsewhere": { hold: (page) => page.mouse.down(), leave: (page) => page.goto("about:blank") },
};

async function halts(browser, station, figures, name, { hold, leave }, { speed_um_per_s, standstill }) {
  const tab = await openTab(browser, station, figures, { mayMove: true, mayFail: true });
  const { page } = tab;
  try {
    await station.call("stage.move", { z_um: 0 });
    await visit(page, station, "/setup?part=devices");
    await page.locator(".setup .parts a").first().click();
    await page.locator(".control-strip button:not(.stop)").click();
    const button = page.locator(".jog:enabled").first();
    await button.waitFor();
    if (speed_um_per_s) await page.locator("input[list=jog-speeds]").fill(String(speed_um_per_s));
    await button.focus();
    await button.hover();
    let repeats = 0;
    page.on("request", (request) => {
      if (methodOf(request) === "stage.jog") ++repeats;
    });
    await hold(page);
    await until("the stage moves", async () => repeats >= 3 && (await station.call("system.state")).busy, 10000);
    const left_ms = now_ms();
    await leave(page);
    const sent = repeats;
    await until("the stage halts", async () => !(await station.call("system.state")).busy, 10000);
    const halted_ms = (standstill ? await standstill(left_ms) : now_ms()) - left_ms;
    // A page that goes on repeating would begin anew.
    await new Promise((wake) => setTimeout(wake, 300));
    if ((await station.call("system.state")).busy || repeats > sent + 1) throw new Error("it went on repeating");
    console.error(`jog, ${name}: ${halted_ms.toFixed(0)} ms, ${repeats} repeats`);
    return halted_ms;
  } finally {
    await tab.close();
    await station.call("control.release");
  }
}

// speed_um_per_s: in place of the page's own. standstill(since_ms): when the stage truly stood, of who sees it; else what the
// daemon says counts, which has to be sure first.
export async function jogEnds(browser, station, figures, how = {}) {
  let worst_ms = 0;
  for (const [name, way] of Object.entries(kWays)) {
    try {
      worst_ms = Math.max(worst_ms, await halts(browser, station, figures, name, way, how));
    } catch (error) {
      console.error(`jog, ${name}: ${error.message.split("\n")[0]}`);
      return null;
    }
  }
  return Math.round(worst_ms);
}
