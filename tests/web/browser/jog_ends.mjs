// A jog ends with the hand and with the page: how long the stage still moves after each way to leave.
import { methodOf, openTab, visit } from "./tab.mjs";
import { until } from "./wait.mjs";

const kWays = {
  "key up": { hold: (page) => page.keyboard.down("Space"), leave: (page) => page.keyboard.up("Space") },
  "pointer up": { hold: (page) => page.mouse.down(), leave: (page) => page.mouse.up() },
  "another page": { hold: (page) => page.mouse.down(), leave: (page) => page.evaluate(() => history.back()) },
  "blur": { hold: (page) => page.mouse.down(), leave: (page) => page.evaluate(() => void window.dispatchEvent(new Event("blur"))) },
  "closed": { hold: (page) => page.keyboard.down("Space"), leave: (page) => page.close() },
  "gone elsewhere": { hold: (page) => page.mouse.down(), leave: (page) => page.goto("about:blank") },
};

async function halts(browser, station, figures, name, { hold, leave }) {
  const tab = await openTab(browser, station, figures, { mayMove: true, mayFail: true });
  const { page } = tab;
  try {
    await station.call("stage.move", { z_um: 0 });
    await visit(page, station, "/setup?part=devices");
    await page.locator(".setup .parts a").first().click();
    await page.locator(".control-strip button:not(.stop)").click();
    const button = page.locator(".jog:enabled").first();
    await button.waitFor();
    await button.focus();
    await button.hover();
    let repeats = 0;
    page.on("request", (request) => {
      if (methodOf(request) === "stage.jog") ++repeats;
    });
    await hold(page);
    await until("the stage moves", async () => repeats >= 3 && (await station.call("system.state")).busy, 10000);
    const left = performance.now();
    await leave(page);
    const sent = repeats;
    await until("the stage halts", async () => !(await station.call("system.state")).busy, 10000);
    const halted_ms = performance.now() - left;
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

export async function jogEnds(browser, station, figures) {
  let worst_ms = 0;
  for (const [name, way] of Object.entries(kWays)) {
    try {
      worst_ms = Math.max(worst_ms, await halts(browser, station, figures, name, way));
    } catch (error) {
      console.error(`jog, ${name}: ${error.message.split("\n")[0]}`);
      return null;
    }
  }
  return Math.round(worst_ms);
}
