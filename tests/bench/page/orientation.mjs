// Whether a letter F under the simulated microscope stands upright on the page: in 2D, in 3D from above, and in profiles.
import { texts } from "../../web/browser/paths.mjs";
import { scan } from "../../web/browser/station.mjs";
import { openTab, settled, visit } from "../../web/browser/tab.mjs";
import { mapPlace, typeLine } from "./map_place.mjs";
import { kReadsPixels, kSoftwareWebGl, phase } from "./phase.mjs";
import { greenOf } from "./pixels.mjs";

// sim/worlds/letter_f.json: of 250 um in the middle of 480 x 360 um, 20 um high; strokes as left, top, width, height.
const kField = { width: 480, height: 360 };
const kStrokes = [[165, 55, 50, 250], [165, 55, 150, 50], [165, 155, 100, 50]];
const isInF = (x, y) => kStrokes.some(([left, top, width, height]) => x >= left && x < left + width && y >= top && y < top + height);

const kWays = {
  upright: (x, y) => isInF(x, y),
  mirrored: (x, y) => isInF(kField.width - x, y),
  "upside down": (x, y) => isInF(x, kField.height - y),
  turned: (x, y) => isInF(kField.width - x, kField.height - y),
};

// How much higher the picture is inside of an F that lies so: grey levels of green.
function contrast({ width, height, green }, toPixel, isInside) {
  const sums = { true: [0, 0], false: [0, 0] };
  for (let y = 30; y < kField.height - 30; y += 3) {
    for (let x = 90; x < kField.width - 90; x += 3) {
      const at = toPixel({ x, y });
      const [column, row] = [Math.round(at.x), Math.round(at.y)];
      if (column < 0 || row < 0 || column >= width || row >= height) continue;
      const sum = sums[isInside(x, y)];
      sum[0] += green[row * width + column];
      ++sum[1];
    }
  }
  return sums.true[0] / sums.true[1] - sums.false[0] / sums.false[1];
}

function isUpright(name, picture, toPixel) {
  const found = Object.fromEntries(Object.entries(kWays).map(([way, isInside]) => [way, contrast(picture, toPixel, isInside)]));
  console.error(`${name}: ${Object.entries(found).map(([way, value]) => `${way} ${value.toFixed(1)}`).join(", ")}`);
  const { upright, ...others } = found;
  return upright > 20 && Object.values(others).every((other) => upright > 1.3 * other);
}

async function isUprightIn2d(page, line) {
  const place = await mapPlace(page, line);
  const canvas = page.locator(".map-canvas");
  const box = await canvas.boundingBox();
  const picture = await greenOf(page, await canvas.screenshot());
  return isUpright("2D", picture, (at) => {
    const { x, y } = place.toScreen(at);
    return { x: x - box.x, y: y - box.y };
  });
}

// From above the half diagonal of the map fills half of the shorter side.
async function isUprightIn3d(page) {
  await page.getByRole("button", { name: "3D", exact: true }).click();
  await page.locator(".view3d-canvas").waitFor();
  await page.getByRole("button", { name: texts.en["result.view3d.above"], exact: true }).click();
  await settled(page);
  const stage = page.locator(".view3d-canvas");
  const picture = await greenOf(page, await stage.screenshot());
  const px_per_um = Math.min(picture.width, picture.height) / 2 / (Math.hypot(kField.width, kField.height) / 2);
  return isUpright("3D", picture, ({ x, y }) => ({
    x: picture.width / 2 + (x - kField.width / 2) * px_per_um, y: picture.height / 2 + (y - kField.height / 2) * px_per_um,
  }));
}

// The profile as its table has it: [[along, height], ...] without holes.
async function profileAlong(page, line) {
  await typeLine(page, line);
  const length = Math.hypot(line.to.x - line.from.x, line.to.y - line.from.y);
  const table = page.locator(".profile-panel details").filter({ has: page.getByText(texts.en["result.profile.table"], { exact: true }) }).first();
  if (!(await table.evaluate((element) => element.open))) await table.locator("summary").click();
  const read = () => page.evaluate(() => [...document.querySelectorAll(".profile-table tbody tr")].map((row) => [...row.cells].slice(0, 2).map((cell) => Number(cell.textContent.replace("−", "-")))));
  await page.waitForFunction((wanted) => {
    const last = [...document.querySelectorAll(".profile-table tbody tr")].at(-1);
    return last && Math.abs(Number(last.cells[0].textContent) - wanted) < 2;
  }, length);
  return (await read()).filter(([, height]) => Number.isFinite(height));
}

// Whether the profile is high between these places, and nowhere else.
function isHighBetween(name, profile, from, to) {
  const mean = (isWanted) => {
    const some = profile.filter(([along]) => isWanted(along)).map(([, height]) => height);
    return some.reduce((sum, height) => sum + height, 0) / some.length;
  };
  const rim = 12;  // um beside an edge, where the focus sees both levels
  const high = mean((along) => along > from + rim && along < to - rim);
  const low = mean((along) => along < from - rim || along > to + rim);
  console.error(`${name}: ${high.toFixed(1)} um between ${from} and ${to}, ${low.toFixed(1)} um beside`);
  return high - low > 15 && high - low < 25;
}

async function areProfilesRight(page) {
  // Across the stem below the arms, from left to right; down through the upper arm's end.
  const across = await profileAlong(page, { from: { x: 20, y: 280 }, to: { x: 460, y: 280 } });
  const down = await profileAlong(page, { from: { x: 295, y: 20 }, to: { x: 295, y: 340 } });
  return isHighBetween("profile to the right", across, 145, 195) && isHighBetween("profile down", down, 35, 85);
}

await phase(async ({ browser, station, figures }) => {
  const [job] = await scan(station.call);
  const { page, close } = await openTab(browser, station, figures, kReadsPixels);
  await visit(page, station, `/jobs/${job}`);
  const line = { from: { x: 30, y: 340 }, to: { x: 450, y: 340 } };  // below the letter, as long as no other
  await typeLine(page, line);
  await page.locator(".map-stage").scrollIntoViewIfNeeded();
  await settled(page);
  const ok = [await isUprightIn2d(page, line), await areProfilesRight(page), await isUprightIn3d(page)];
  await close();
  return { orientation_ok: ok.every(Boolean) };
}, { world: "letter_f", browser: kSoftwareWebGl });
