// What is read out under the cursor, beside the file: at 200 random points, of the whole map, of one that is smaller than
// its canvas, and of one that is enlarged.
import { texts } from "../../web/browser/paths.mjs";
import { openTab, settled, visit } from "../../web/browser/tab.mjs";
import { makeResults } from "./made_results.mjs";
import { mapPlace, notePlaces, notedPlace, typeLine } from "./map_place.mjs";
import { phase } from "./phase.mjs";
import { generator } from "./random.mjs";

const kSize = { width: 1280, height: 960 };
const kSlack_px = 0.05;  // a browser rounds where things are to a 64th of a pixel
const kViews = [
  { name: "whole", points: 80, press: [] },
  { name: "smaller", points: 40, press: ["result.zoom_out"] },
  { name: "enlarged", points: 80, press: ["result.fit", "result.zoom_in", "result.zoom_in", "result.zoom_in", "result.zoom_in", "result.zoom_in"] },
];

async function readAt(page, at) {
  await page.mouse.move(at.x, at.y);
  const readout = page.locator("dl.readout[data-state=there]").first();
  await readout.waitFor();
  return readout.evaluate((element) => ({
    column: Number(element.dataset.column), row: Number(element.dataset.row), height_m: Number(element.querySelectorAll("data")[2].value),
  }));
}

await phase(async ({ browser, station, figures }) => {
  const { jobs, pitch_um: [pitch_x, pitch_y], width, height, heights_m } = await makeResults(station, kSize);
  const { page, close } = await openTab(browser, station, figures);
  await visit(page, station, `/jobs/${jobs[0]}`);
  const line = { from: { x: 100, y: 300 }, to: { x: 500, y: 300 } };
  await typeLine(page, line);
  const stage = page.locator(".map-stage");
  await notePlaces(page);
  const pick = generator(7);
  const sums = { readout_worst_um: 0, readout_misplaced: 0, readout_points: 0, readout_holes: 0 };
  const look = async (name, at) => {
    const { column, row, height_m } = await readAt(page, at);
    const place = await notedPlace(page, line);
    const there = place.toMap(at);
    const slack = kSlack_px * place.um_per_px;
    const isThere = Math.abs((column + 0.5) * pitch_x - there.x) <= 0.5 * pitch_x + slack && Math.abs((row + 0.5) * pitch_y - there.y) <= 0.5 * pitch_y + slack;
    const file_m = heights_m[row * width + column];
    ++sums.readout_points;
    sums.readout_holes += Number.isNaN(file_m) ? 1 : 0;
    if (!isThere) {
      ++sums.readout_misplaced;
      console.error(`${name}: point ${column}, ${row} is read out at ${there.x.toFixed(2)}, ${there.y.toFixed(2)} um (of ${(column + 0.5) * pitch_x}, ${(row + 0.5) * pitch_y})`);
    }
    const error_um = Number.isNaN(file_m) !== Number.isNaN(height_m) ? Infinity : Number.isNaN(file_m) ? 0 : 1e6 * Math.abs(file_m - height_m);
    if (error_um > 0) console.error(`${name}: point ${column}, ${row} is ${1e6 * file_m} um in the file, ${1e6 * height_m} um on the page`);
    sums.readout_worst_um = Math.max(sums.readout_worst_um, error_um);
  };
  for (const { name, points, press } of kViews) {
    for (const key of press) await page.getByRole("button", { name: texts.en[key], exact: true }).click();
    await settled(page);
    await stage.scrollIntoViewIfNeeded();
    const place = await mapPlace(page, line);
    const box = await page.locator(".map-canvas").boundingBox();
    for (let done = 0; done < points;) {
      // Whole: a browser tells a mouse's place in whole pixels.
      const at = { x: Math.ceil(box.x + 2 + pick() * (box.width - 4)), y: Math.ceil(box.y + 2 + pick() * (box.height - 4)) };
      const there = place.toMap(at);
      const margin = 2 * place.um_per_px;
      if (there.x < margin || there.y < margin || there.x > width * pitch_x - margin || there.y > height * pitch_y - margin) continue;
      await look(name, at);
      ++done;
    }
  }
  await close();
  // JSON knows no infinity.
  return { ...sums, readout_worst_um: Number.isFinite(sums.readout_worst_um) ? sums.readout_worst_um : 1e9 };
});
