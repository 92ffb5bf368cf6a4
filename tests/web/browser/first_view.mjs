// What the first view costs: requests, bytes, time from the address to the state on the screen.
import { openTab } from "./tab.mjs";

export async function firstView(browser, station, figures) {
  const tab = await openTab(browser, station, figures, {});
  const { page } = tab;
  const kinds = new Set();
  let requests = 0;
  page.on("request", (request) => {
    if (/^(blob|data):/.test(request.url())) return;
    ++requests;
    kinds.add(new URL(request.url()).pathname);
  });
  try {
    const begun = performance.now();
    await page.goto(station.url, { waitUntil: "commit" });
    await page.waitForFunction(() => document.querySelector("main > *") && document.querySelector("header .bar") && !document.querySelector("header .link"));
    const first_view_ms = Math.round(performance.now() - begun);
    const requests_first_view = requests;
    const bundle_gz_kib = await page.evaluate(() => performance.getEntriesByType("resource").concat(performance.getEntriesByType("navigation"))
      .filter(({ name }) => !new URL(name).pathname.startsWith("/api/")).reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0) / 1024);
    console.error(`first view: ${[...kinds].join(" ")}`);
    return { requests_first_view, first_view_ms, bundle_gz_kib: Number(bundle_gz_kib.toFixed(1)) };
  } finally {
    await tab.close();
  }
}
