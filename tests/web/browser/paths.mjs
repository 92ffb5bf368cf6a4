// Where things are, and the packages that the page's folder has installed.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
export const web = join(root, "daemon/web");
export const shots = join(root, "tests/web/shots");
export const build = resolve(root, process.env.FVD_BUILD ?? "build");

const require = createRequire(join(web, "package.json"));
export const { chromium } = require("playwright-core");
export const axeSource = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

export const texts = Object.fromEntries(
  ["en", "de"].map((language) => [language, JSON.parse(readFileSync(join(web, `src/i18n/${language}.json`), "utf8"))]));

// How many texts one of the languages lacks.
const lacking = (of, beside) => Object.keys(of).filter((key) => !(key in beside)).length;
export const untranslated = lacking(texts.en, texts.de) + lacking(texts.de, texts.en);
