// Writes tests/web/shots/README.md: the pictures of a walk, a sentence each. Needs no browser and no station.
//
// node tests/web/browser/list_shots.mjs [--check] : --check writes nothing, and ends with 1 where the file is another.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { listOf } from "./shots.mjs";
import { statesOf } from "./states.mjs";

const folder = join(dirname(fileURLToPath(import.meta.url)), "../shots");
const file = join(folder, "README.md");
const list = listOf(statesOf({ jobs: ["a", "b"], recipe: "groove", odd: {} }));
if (process.argv.includes("--check")) {
  let there = "";
  try {
    there = readFileSync(file, "utf8");
  } catch {
    // there is none
  }
  if (there !== list) {
    console.error(`${file} is not what the states say: node tests/web/browser/list_shots.mjs`);
    process.exitCode = 1;
  }
} else {
  mkdirSync(folder, { recursive: true });
  writeFileSync(file, list);
}
