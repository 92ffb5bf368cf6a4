// Nothing is used that browsers of mid 2022 lack. The compiler refuses what the language got later (its lib is es2022), and
// the build writes newer syntax as older; what browsers got later beside the language is listed here.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";

declare const WEB_DIR: string;

// What it looks like, and since which Chromium and Firefox it is there.
const kInScripts: readonly (readonly [RegExp, string, string])[] = [
  [/\bAbortSignal\.(any|timeout)\(/, "AbortSignal.any([a, b])", "116, 124"],
  [/\bURL\.(canParse|parse)\(/, "URL.canParse(text)", "120, 115"],
  [/\b(query|search|params)\w*\.size\b/i, "query.size === 0", "113, 112"],
  [/\bResponse\.json\(/, "Response.json({})", "105, 115"],
  [/\bReadableStream\.from\(|\bfor await\b/, "for await (const piece of body)", "124, 110"],
  [/\b(De)?[cC]ompressionStream\b/, "new DecompressionStream(\"gzip\")", "80, 113"],
  [/\bOffscreenCanvas\b/, "new OffscreenCanvas(1, 1)", "69, 105"],
  [/\.roundRect\(/, "context.roundRect(0, 0, 1, 1, 1)", "99, 112"],
  [/\b(show|hide|toggle)Popover\b|\spopover=/, "<div popover=\"auto\">", "114, 125"],
  [/\sinert\b|\.inert\b/, "element.inert = true", "102, 112"],
  [/\.checkVisibility\(/, "element.checkVisibility()", "105, 106"],
  [/"scrollend"|\bonScrollEnd\b/, "addEventListener(\"scrollend\", end)", "114, 109"],
  [/\bstartViewTransition\b/, "document.startViewTransition(draw)", "111, 144"],
  [/\bIntl\.(Segmenter|DurationFormat)\b/, "new Intl.Segmenter()", "87, 125"],
  [/\b(roundingPriority|roundingIncrement|roundingMode|trailingZeroDisplay)\b|"(min2|negative)"/, "{ signDisplay: \"negative\" }", "106, 116"],
  [/\bnavigator\.userActivation\b/, "navigator.userActivation.isActive", "72, 120"],
  [/:modal\b/, "document.querySelector(\"dialog:modal\")", "105, 103"],
];
const kInSheets: readonly (readonly [RegExp, string, string])[] = [
  [/:has\(/, "label:has(input) {}", "105, 121"],
  [/:modal\b|:open\b|:popover-open\b/, "dialog:modal {}", "105, 103"],
  [/:user-(in)?valid\b/, "input:user-invalid {}", "119, 88"],
  [/@(container|property|scope|starting-style)\b/, "@container (width > 1px) {}", "105, 110"],
  [/\b(color-mix|light-dark|oklch|oklab|lch|lab|linear)\(/, "color: color-mix(in srgb, red, blue)", "111, 113"],
  [/\d(dvh|svh|lvh|dvw|svw|lvw)\b/, "height: 100dvh", "108, 101"],
  [/[{;]\s*(rotate|scale|translate)\s*:/, "{ rotate: 3deg }", "104, 72"],
  [/\bsubgrid\b/, "grid-template-rows: subgrid", "117, 71"],
  [/\bcontain(er)?(-\w+)?\s*:[^;]*inline-size/, "contain: inline-size", "105, 101"],
  [/\b(text-wrap|field-sizing|scrollbar-(color|width)|anchor-name|animation-timeline|interpolate-size)\s*:/, "text-wrap: balance", "114, 121"],
];

function files(folder: string, end: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? files(path, end) : entry.name.endsWith(end) ? [path] : [];
  });
}
const withoutComments = (text: string): string => text.replace(/\/\*[^]*?\*\//g, "").replace(/(^|\s)\/\/.*$/gm, "$1");

for (const [what, end, list] of [["scripts", ".ts", kInScripts], ["style sheets", ".css", kInSheets]] as const) {
  test(`${what} use nothing that is newer`, () => {
    const sources = files(join(WEB_DIR, "src"), end).map((path) => [path, withoutComments(readFileSync(path, "utf8"))] as const);
    assert.ok(sources.length > 5);
    const found = sources.flatMap(([path, text]) => list.filter(([pattern]) => pattern.test(text)).map(([pattern, , since]) => `${path}: ${pattern.exec(text)?.[0]} (${since})`));
    assert.deepEqual(found, []);
  });

  test(`the list for ${what} finds what it is there for`, () => {
    for (const [pattern, example] of list) assert.match(example, pattern);
  });
}

test("build, compiler and README mean the same browsers", () => {
  const build = readFileSync(join(WEB_DIR, "build.mjs"), "utf8");
  assert.match(build, /const kBrowsers = \["chrome102", "firefox102"\];/);
  assert.match(readFileSync(join(WEB_DIR, "README.md"), "utf8"), /Chromium 102 and Firefox 102/);
  const { lib } = (JSON.parse(readFileSync(join(WEB_DIR, "tsconfig.json"), "utf8")) as { compilerOptions: { lib: string[] } }).compilerOptions;
  assert.deepEqual(lib.filter((each) => each.startsWith("es")), ["es2022"]);
});
