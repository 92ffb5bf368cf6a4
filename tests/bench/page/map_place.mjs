// Where a point of the map is on the screen, told by the line that the page has drawn over it.

// In the page: where the line's ends are in the window.
function lineInWindow() {
  const overlay = document.querySelector(".map-overlay");
  const { left, top, width } = overlay.getBoundingClientRect();
  const scale = width / overlay.viewBox.baseVal.width;
  const [x1, y1, x2, y2] = overlay.querySelector("path.profile-line:not(.under)").getAttribute("d").match(/-?[\d.]+(?:e-?\d+)?/g).map(Number);
  return { from: { x: left + scale * x1, y: top + scale * y1 }, to: { x: left + scale * x2, y: top + scale * y2 } };
}

function placeBy(drawn, line) {
  const px_per_um = Math.hypot(drawn.to.x - drawn.from.x, drawn.to.y - drawn.from.y) / Math.hypot(line.to.x - line.from.x, line.to.y - line.from.y);
  return {
    um_per_px: 1 / px_per_um,
    toScreen: ({ x, y }) => ({ x: drawn.from.x + (x - line.from.x) * px_per_um, y: drawn.from.y + (y - line.from.y) * px_per_um }),
    toMap: ({ x, y }) => ({ x: line.from.x + (x - drawn.from.x) / px_per_um, y: line.from.y + (y - drawn.from.y) / px_per_um }),
  };
}

// line: { from, to } in um. { toScreen({x, y} in um), toMap({x, y} of the window), um_per_px }
export const mapPlace = async (page, line) => placeBy(await page.evaluate(lineInWindow), line);

// From now on the page notes where the map is whenever the pointer moves: a page that grows meanwhile scrolls it.
export const notePlaces = (page) => page.evaluate(`addEventListener("pointermove", () => { window.fvdLine = (${lineInWindow})(); }, { capture: true })`);

// As mapPlace() of the moment of the pointer's last move.
export const notedPlace = async (page, line) => placeBy(await page.evaluate(() => window.fvdLine), line);

// Types the ends of the profile, in um, and its band; waits for its curve.
export async function typeLine(page, { from, to, width_um = 0 }) {
  const fields = page.locator(".profile-panel .controls").first().locator(".number-field input");
  for (const [i, value] of [from.x, from.y, to.x, to.y, width_um].entries()) {
    await fields.nth(i).fill(String(value));
    await fields.nth(i).press("Enter");
  }
}
