// All pages in all states, light and dark, English and German: rules of accessibility, overflow, small targets, texts.
import { makeOddResults, oddRecipes } from "../../web/browser/odd_results.mjs";
import { untranslated } from "../../web/browser/paths.mjs";
import { scan } from "../../web/browser/station.mjs";
import { walk } from "../../web/browser/walk.mjs";
import { phase } from "./phase.mjs";

const recipe = "groove";

await phase(async ({ browser, station, figures }) => {
  const odd = await makeOddResults(station.call, recipe);
  const jobs = await scan(station.call, { recipe, parts: 2 });
  await station.call("verify.noise", { jobs });
  return { untranslated, ...await walk(browser, station, figures, { jobs, recipe, odd }) };
}, { recipes: oddRecipes() });
