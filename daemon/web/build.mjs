// Makes the page: types, a check of them, scripts, one style sheet, compressed, with names that say what is in them.
//
// node build.mjs [--out DIR] : DIR (default dist) gets index.html, icon.svg, assets/*, and the same as *.gz,
// and files.txt: one line a file, "path type", in the order in which they are embedded.
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import { methodTypes } from "./method_types.mjs";

// The oldest that the page is made for: of mid 2022, as Firefox's long support. README.md says so too, and a test that nothing newer is used.
const kBrowsers = ["chrome102", "firefox102"];

const here = dirname(fileURLToPath(import.meta.url));
const at = process.argv.indexOf("--out");
const out = at < 0 ? join(here, "dist") : process.argv[at + 1];

const types = methodTypes(JSON.parse(readFileSync(join(here, "openrpc.json"), "utf8")));
writeFileSync(join(here, "src/rpc/methods.ts"), types);
try {
  execFileSync(process.execPath, [join(here, "node_modules/typescript/bin/tsc"), "-p", join(here, "tsconfig.json")], { stdio: "inherit" });
} catch {
  process.exit(1);  // the compiler has told why
}

const options = { absWorkingDir: here, bundle: true, minify: true, target: kBrowsers, legalComments: "none", charset: "utf8", outdir: "dist/assets", write: false };
// Scripts: what the first view needs, the pages that are opened later, each language.
const made = await build({
  ...options,
  entryPoints: { main: "src/main.ts" },
  format: "esm",
  splitting: true,
  entryNames: "[name]-[hash]",
  chunkNames: "[name]-[hash]",
  loader: { ".css": "empty" },
  metafile: true,
});
// All style sheets in one, in the order in which the scripts name them: a page that comes later must not wait for its colours.
const sheets = Object.keys(made.metafile.inputs).filter((path) => path.endsWith(".css"));
const style = await build({
  ...options,
  stdin: { contents: sheets.map((path) => `@import ${JSON.stringify(`./${path}`)};`).join("\n"), loader: "css", resolveDir: here },
});

rmSync(out, { recursive: true, force: true });
mkdirSync(join(out, "assets"), { recursive: true });
const files = [];
function keep(path, type, bytes) {
  writeFileSync(join(out, path), bytes);
  const packed = gzipSync(bytes, { level: 9 });
  writeFileSync(join(out, `${path}.gz`), packed);
  files.push({ path, type, packed: packed.length });
}

let page = readFileSync(join(here, "index.html"), "utf8");
for (const file of made.outputFiles) {
  const name = basename(file.path);
  if (name.startsWith("main-")) page = page.replace("/assets/main.js", `/assets/${name}`);
  keep(`assets/${name}`, "text/javascript; charset=utf-8", Buffer.from(file.contents));
}
for (const file of style.outputFiles) {
  const name = `main-${createHash("sha256").update(file.contents).digest("hex").slice(0, 12)}.css`;
  page = page.replace("/assets/main.css", `/assets/${name}`);
  keep(`assets/${name}`, "text/css; charset=utf-8", Buffer.from(file.contents));
}
keep("icon.svg", "image/svg+xml", readFileSync(join(here, "icon.svg")));
keep("index.html", "text/html; charset=utf-8", Buffer.from(page));
writeFileSync(join(out, "files.txt"), files.map(({ path, type }) => `${path}\t${type}\n`).join(""));
const kib = (counted) => (counted.reduce((sum, { packed }) => sum + packed, 0) / 1024).toFixed(1);
// What a browser fetches before somebody goes on: whatever the first script names, and one language.
const outputs = made.metafile.outputs;
const needed = (path) => [path, ...outputs[path].imports.filter(({ kind }) => kind === "import-statement").flatMap((each) => needed(each.path))];
const main = Object.keys(outputs).find((path) => basename(path).startsWith("main-"));
const firstNames = new Set(needed(main).map((path) => basename(path)));
const first = files.filter(({ path }) => firstNames.has(basename(path)) || !path.endsWith(".js") || basename(path).startsWith("en-"));
console.log(`page: ${files.length} files, ${kib(files)} KiB compressed, ${kib(first)} KiB in ${first.length} files at the first view`);
