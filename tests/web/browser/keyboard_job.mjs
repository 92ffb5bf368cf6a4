// A job without a pointer: log in, name the part, choose the recipe, start, read the verdict, open the profile.
import { texts } from "./paths.mjs";
import { openTab, visit } from "./tab.mjs";
import { until } from "./wait.mjs";

const kMostTabs = 120;

// Goes on with Tab until what has the focus satisfies the test; a test is code for the page.
async function tabTo(page, what, test) {
  for (let i = 0; i < kMostTabs; ++i) {
    if (await page.evaluate(`(${test})(document.activeElement)`)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`Tab does not reach ${what}`);
}

const labelled = (label) => `(element) => [...(element?.labels ?? [])].some((each) => each.textContent.trim().startsWith(${JSON.stringify(label)}))`;
const isButton = (text) => `(element) => element?.tagName === "BUTTON" && element.textContent.trim() === ${JSON.stringify(text)}`;
const isFocused = (selector) => `(element) => element?.matches?.(${JSON.stringify(selector)})`;

async function chooseRecipe(page, recipe) {
  await tabTo(page, "the recipe", labelled(texts.en["run.recipe"]));
  // A list that is not open takes what is typed as the beginning of an option.
  await page.keyboard.type(recipe);
  await until("the recipe is chosen", () => page.evaluate(() => document.activeElement.value).then((value) => value === recipe), 5000);
}

export async function keyboardJob(browser, station, figures, recipe = "groove") {
  const tab = await openTab(browser, station, figures, { token: null, mayMove: true });
  const { page } = tab;
  const steps = [];
  try {
    await visit(page, station, "/");
    await tabTo(page, "the log-in", isButton(texts.en["session.log_in"]));
    await page.keyboard.press("Enter");
    await page.keyboard.type(station.operator);
    await page.keyboard.press("Enter");
    await page.locator(".session-who").waitFor();
    steps.push("logged in");

    const part = `keys-${Date.now() % 1e6}`;
    await tabTo(page, "the part", labelled(texts.en["run.part"]));
    await page.keyboard.type(part);
    await chooseRecipe(page, recipe);
    steps.push("recipe chosen");
    await page.keyboard.press("F9");
    await until("the job has begun", async () => (await page.evaluate(() => document.body.innerText)).includes(part));
    const verdict = await until("a verdict", () => page.evaluate((wanted) => {
      const banner = document.querySelector(".banner-verdict");
      return banner?.textContent.includes(wanted) ? banner.querySelector(".verdict")?.textContent.trim() : "";
    }, part), 120000);
    steps.push(`verdict ${verdict}`);

    await tabTo(page, "the result", isFocused('a[href^="/jobs/"]'));
    await page.keyboard.press("Enter");
    await until("the result's page", () => page.url().includes("/jobs/"));
    await page.locator(".profile-panel").waitFor();
    await tabTo(page, "the profile", isFocused(".profile-panel input"));
    // Another beginning of the line: another curve, as its table says.
    const title = () => page.locator(".profile-plot").getAttribute("aria-label");
    const before = await title();
    await page.keyboard.press("Control+A");
    await page.keyboard.type("1");
    await page.keyboard.press("Enter");
    await until("the curve of another line", async () => await title() !== before);
    steps.push("profile");
    return true;
  } catch (error) {
    console.error(`keyboard only, after ${steps.join(", ") || "nothing"}: ${error.message}`);
    return false;
  } finally {
    await tab.close();
  }
}
