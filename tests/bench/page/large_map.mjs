// A map of 20 Mpx: from the press on its link to the first picture, of a result that the daemon has not opened yet; then
// frames a second while it is dragged, and while it is zoomed.
import { texts } from "../../web/browser/paths.mjs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { rounded, told } from "./clock.mjs";
import { framesWhile } from "./map_frames.mjs";
import { makeResults } from "./made_results.mjs";
import { kSoftwareWebGl, phase, rounds } from "./phase.mjs";

const kSize = { width: 5472, height: 3648 };
const kDrive_ms = 3000;

// Within the page, as a link does it: its scripts are there, the map is not.
function firstPicture_ms(page, job) {
  return page.evaluate((path) => new Promise((tell) => {
    const probe = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
    const isPainted = () => {
      const canvas = document.querySelector(".map-canvas");
      if (!canvas || canvas.width === 0) return false;
      probe.clearRect(0, 0, 1, 1);
      probe.drawImage(canvas, canvas.width / 2, canvas.height / 2, 1, 1, 0, 0, 1, 1);
      return probe.getImageData(0, 0, 1, 1).data[3] > 0;
    };
    const link = document.createElement("a");
    link.href = path;
    document.body.append(link);
    const pressed = performance.now();
    link.click();
    link.remove();
    const look = () => requestAnimationFrame(isPainted() ? () => tell(performance.now() - pressed) : look);
    look();
  }), `/jobs/${job}`);
}

await phase(async ({ browser, station, figures }) => {
  const { jobs } = await makeResults(station, { ...kSize, copies: rounds(6) });
  const { page, close } = await openTab(browser, station, figures, { mayFail: true });
  const first_ms = [];
  for (const job of jobs) {
    await visit(page, station, `/jobs/no-${job}`);  // of the result's page, without a result: its scripts are fetched
    first_ms.push(await firstPicture_ms(page, job));
  }
  told("first picture of 20 Mpx", first_ms);

  await page.locator(".map-stage").scrollIntoViewIfNeeded();
  await page.getByRole("button", { name: texts.en["result.zoom_in"], exact: true }).click();
  const drag = await framesWhile(page, "drag", kDrive_ms);
  const zoom = await framesWhile(page, "zoom", kDrive_ms);
  console.error(`20 Mpx: ${drag.toFixed(1)} frames/s dragged, ${zoom.toFixed(1)} zoomed`);
  await close();
  return { height_20mpx_first_ms: Math.round(Math.max(...first_ms)), pan_zoom_fps: rounded(Math.min(drag, zoom)), first_pictures: first_ms.length };
}, { browser: kSoftwareWebGl });
