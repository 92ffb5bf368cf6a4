// What is around every measurement in a browser: a station, the browser, the counters of what must not happen. All of it
// is ended whatever happens; the last line is one JSON object.
import { openBrowser } from "../../web/browser/launch.mjs";
import { startStation } from "../../web/browser/station.mjs";
import { newFigures } from "../../web/browser/tab.mjs";

// WebGL2 by a processor where there is no graphics card, and nothing else by it: a page that is composed by OpenGL, which
// --use-angle=swiftshader makes of it, is a tenth as fast, and no browser does so by itself.
export const kSoftwareWebGl = ["--enable-unsafe-swiftshader"];
export const kReadsPixels = { mayWarn: /GPU stall due to ReadPixels/ };  // for openTab(): it is the measurement that reads

// Else the program ends at once, and leaves what it has started.
process.on("unhandledRejection", (error) => {
  console.error(error);
  process.exitCode = 1;
});

// measure({ browser, station, figures }) returns its figures; `figures` are the counters, for openTab().
// options: those of startStation(), and `browser`: more words for the browser.
export async function phase(measure, { browser: words = [], ...wanted } = {}) {
  const figures = newFigures();
  let station;
  let browser;
  try {
    station = await startStation(wanted);
    browser = await openBrowser(words);
    const measured = await measure({ browser, station, figures });
    console.log(JSON.stringify({ ...figures, ...measured }));
  } catch (error) {
    console.error(error.stack);
    process.exitCode = 1;
  } finally {
    await browser?.close();
    await station?.stop();
  }
}

// How often something is repeated, unless FVD_PAGE_ROUNDS says otherwise: for a try.
export const rounds = (usual) => Number(process.env.FVD_PAGE_ROUNDS || usual);
