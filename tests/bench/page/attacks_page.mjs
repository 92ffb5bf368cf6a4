// Texts of others on the page: markup in a part id, a recipe and the names of devices stays text, a formula in a part id
// is none in the CSV. The last line is one JSON object; attacks.py starts it, with a station that has such texts.
import { readFileSync } from "node:fs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { texts } from "../../web/browser/paths.mjs";
import { phase } from "./phase.mjs";

const [, script, formula] = (process.env.FVD_ATTACK_JOBS ?? "").split(",");
const kScriptPart = "<img src=q onerror=alert(1)>";
const kFormulaPart = '=HYPERLINK("http://h","x")';

// What an attack would have done: an element of its own, a request, a question to the person.
async function wasHarmed(tab, harm) {
  const element = await tab.page.evaluate(() => document.querySelector("img[src='q'], #dev, main script")?.outerHTML ?? "");
  if (element) harm.push(`element ${element}`);
  return harm.length > 0;
}

async function staysText({ browser, station, figures }, paths, isShown) {
  const tab = await openTab(browser, station, figures, { mayFail: true });
  const harm = [];
  tab.page.on("dialog", (dialog) => {
    harm.push(`dialog ${dialog.message()}`);
    void dialog.dismiss();
  });
  tab.page.on("request", (request) => {
    if (new URL(request.url()).pathname.endsWith("/q")) harm.push(`request ${request.url()}`);
  });
  try {
    let seen = isShown === null;
    for (const path of paths) {
      await visit(tab.page, station, path);
      if (await wasHarmed(tab, harm)) break;
      seen = seen || await tab.page.evaluate((text) => document.body.innerText.includes(text) || [...document.querySelectorAll("textarea, input")].some(({ value }) => value.includes(text)), isShown);
    }
    if (!seen) harm.push(`${isShown} is nowhere to be seen: nothing was tried`);
  } finally {
    await tab.close();
  }
  return harm;
}

async function csvIsPlain({ browser, station, figures }) {
  const tab = await openTab(browser, station, figures, { mayFail: true });
  try {
    await visit(tab.page, station, "/jobs");
    const [download] = await Promise.all([
      tab.page.waitForEvent("download"), tab.page.getByRole("button", { name: texts.en["history.csv"], exact: true }).click()]);
    const text = readFileSync(await download.path(), "utf8");
    const quoted = `"'${kFormulaPart.replaceAll('"', '""')}"`;
    return text.includes(quoted) && !text.includes(`,${kFormulaPart}`) ? [] : [`the CSV is ${text.slice(0, 500)}`];
  } finally {
    await tab.close();
  }
}

const kRows = {
  "stored script: in a part id": (about) => staysText(about, ["/", "/jobs", `/jobs/${script}`, `/jobs?compare=${script},${formula}`], kScriptPart),
  "stored script: in a recipe": (about) => staysText(about, ["/recipes", "/recipes/evil"], "<script>alert(1)</script>"),
  // No page shows what a device calls itself, unless an alarm does.
  "stored script: in the names of devices": (about) => staysText(about, ["/", "/setup", "/setup?part=devices", "/setup?part=journal"], null),
  "formula: in the CSV of the history": csvIsPlain,
};

await phase(async (about) => {
  let refused = 0;
  for (const [name, attack] of Object.entries(kRows)) {
    const harm = await attack(about).catch((error) => [error.message]);
    refused += harm.length === 0 ? 1 : 0;
    console.error(`attack: ${name}: ${harm.length === 0 ? "refused" : `NOT REFUSED: ${harm.join("; ")}`}`);
  }
  return { rows: Object.keys(kRows).length, refused };
});
