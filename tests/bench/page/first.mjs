// What the first view costs: the worst of five with nothing kept of the one before; and all of the page, for knowledge.
import { firstView } from "../../web/browser/first_view.mjs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { phase, rounds } from "./phase.mjs";
import { rounded } from "./clock.mjs";

// Every file of the page in one language.
async function wholePage(browser, station, figures, language) {
  const files = new Map();
  const tab = await openTab(browser, station, figures, { language });
  try {
    for (const path of ["/", "/jobs", "/recipes", "/setup"]) {
      await visit(tab.page, station, path);
      const taken = await tab.page.evaluate(() => performance.getEntriesByType("resource").map(({ name, encodedBodySize }) => [new URL(name).pathname, encodedBodySize]));
      for (const [name, bytes] of taken) if (!name.startsWith("/api/")) files.set(name, Math.max(bytes, files.get(name) ?? 0));
    }
  } finally {
    await tab.close();
  }
  return files;
}

await phase(async ({ browser, station, figures }) => {
  const views = [];
  for (let i = 0; i < rounds(5); ++i) views.push(await firstView(browser, station, figures));
  const worst = (key) => Math.max(...views.map((view) => view[key]));
  const all = new Map([...await wholePage(browser, station, figures, "en"), ...await wholePage(browser, station, figures, "de")]);
  return {
    requests_first_view: worst("requests_first_view"), first_view_ms: worst("first_view_ms"), bundle_gz_kib: worst("bundle_gz_kib"),
    whole_page_gz_kib: rounded([...all.values()].reduce((sum, bytes) => sum + bytes, 0) / 1024),
  };
});
