// The 3D view by a processor: frames a second while it turns (128 x 128), and how soon it is fine (512 x 512) when it
// rests. Each frame counts when one of its pixels was read back.
import { texts } from "../../web/browser/paths.mjs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { rounded, told } from "./clock.mjs";
import { makeResults } from "./made_results.mjs";
import { kReadsPixels, kSoftwareWebGl, phase, rounds } from "./phase.mjs";

const kSide = 2048;
const kTurn_ms = 3000;
const kLeastFine = 1_000_000;  // indices of triangles: 512 x 512 without holes has 1.5 million, 128 x 128 a sixteenth

// Notes each picture: how many triangles' indices, and when its pixels were there.
function watchDrawings() {
  window.fvdDrawings = [];
  const draw = WebGL2RenderingContext.prototype.drawElements;
  WebGL2RenderingContext.prototype.drawElements = function (mode, count, ...rest) {
    draw.call(this, mode, count, ...rest);
    if (mode === this.TRIANGLES) this.fvdCount = count;
    else {  // the border is drawn last
      this.readPixels(0, 0, 1, 1, this.RGBA, this.UNSIGNED_BYTE, new Uint8Array(4));
      window.fvdDrawings.push({ count: this.fvdCount, at_ms: performance.now() });
    }
  };
}

// Turns for a while, rests, and waits for the fine picture.
async function turn(page) {
  const { x, y, width, height } = await page.locator(".view3d-stage").boundingBox();
  const middle = { x: x + width / 2, y: y + height / 2 };
  await page.mouse.move(middle.x, middle.y);
  await page.mouse.down();
  try {
    return await page.evaluate(async ({ begin, turn_ms, fine }) => {
      const stage = document.querySelector(".view3d-stage");
      const drawings = window.fvdDrawings;
      const more = async (isIt, within_ms) => {
        const asked = performance.now();
        for (;;) {
          const found = drawings.find(isIt);
          if (found) return found;
          if (performance.now() - asked > within_ms) throw new Error(`no such picture among ${drawings.length}`);
          await new Promise(requestAnimationFrame);
        }
      };
      const begun = performance.now();
      let frames = 0;
      let moved = begun;
      for (let i = 0; performance.now() - begun < turn_ms; ++i) {
        drawings.length = 0;
        // As a hand's moves, which come before a frame: within one, the picture would wait for the next.
        await scheduler.postTask(() => undefined);
        moved = performance.now();
        stage.dispatchEvent(new PointerEvent("pointermove", { bubbles: true, pointerId: 1, pointerType: "mouse", buttons: 1, clientX: begin.x + 3 * i, clientY: begin.y }));
        await null;  // drawn anew, which asks for its frame
        const { count } = await more(() => true, 5000);
        if (count < fine) ++frames;
      }
      const fps = (1000 * frames) / (performance.now() - begun);
      drawings.length = 0;
      const rested = await more(({ count }) => count >= fine, 10000);
      return { fps, fine_ms: rested.at_ms - moved };
    }, { begin: middle, turn_ms: kTurn_ms, fine: kLeastFine });
  } finally {
    await page.mouse.up();
  }
}

await phase(async ({ browser, station, figures }) => {
  const { jobs } = await makeResults(station, { width: kSide, height: kSide });
  const { page, close } = await openTab(browser, station, figures, kReadsPixels);
  await page.addInitScript(watchDrawings);
  await visit(page, station, `/jobs/${jobs[0]}`);
  await page.getByRole("button", { name: "3D", exact: true }).click();
  await page.waitForFunction((least) => window.fvdDrawings.some(({ count }) => count >= least), kLeastFine);
  const isRelief = await page.locator(".view3d-relief").count() > 0;
  if (isRelief) throw new Error(`no WebGL2: ${texts.en["result.view3d.relief"]}`);
  await page.locator(".view3d-stage").scrollIntoViewIfNeeded();
  const turns = [];
  for (let i = 0; i < rounds(5); ++i) turns.push(await turn(page));
  await close();
  told("fine after rest", turns.map(({ fine_ms }) => fine_ms));
  return { view3d_fps: rounded(Math.min(...turns.map(({ fps }) => fps))), view3d_fine_ms: Math.round(Math.max(...turns.map(({ fine_ms }) => fine_ms))) };
}, { browser: kSoftwareWebGl });
