// Results that nobody wishes for: recipes that provoke them in a simulated groove, and the jobs.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { scan } from "./station.mjs";

const config = join(dirname(fileURLToPath(import.meta.url)), "../../../config");
const groove = () => JSON.parse(readFileSync(join(config, "recipes/groove.json"), "utf8"));

// By id, for startStation().
export function oddRecipes() {
  const no_point = groove();
  no_point.description = "No focus curve is good enough: every point is a hole";
  Object.assign(no_point.reconstruct.focus, { min_prominence: 1, min_significance: 1e6 });
  const bare = groove();
  bare.description = "Limits to one side alone, also of values without U, and more valid points than there are";
  bare.reconstruct.min_valid_fraction = 0.9999;
  bare.evaluation.measurements.step.limits = { height_um: { lower: 49.5 }, width_um: { lower: 80 } };
  bare.evaluation.measurements.land.limits = { Sa_um: { upper: 0.5 } };
  return { no_point, bare };
}

const kScript = "<script>alert(1)</script>\"'&";
const kLong = `${"long-part-id-without-a-blank-".repeat(2)}000001`;  // 64 characters, the most that a part id has

// { noPoint, bare, scripted, long }: ids of jobs.
export async function makeOddResults(call, recipe) {
  const [noPoint] = await scan(call, { recipe: "no_point" });
  const [bare] = await scan(call, { recipe: "bare" });
  const [scripted] = await scan(call, { recipe, part_id: kScript });
  const [long] = await scan(call, { recipe, part_id: kLong });
  return { noPoint, bare, scripted, long };
}
