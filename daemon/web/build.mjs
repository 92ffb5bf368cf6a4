// Makes the page: types, a check of them, one script, one style sheet, compressed, with names that say what is in them.
//
// node build.mjs [--out DIR] : DIR (default dist) gets index.html, icon.svg, assets/*, and the same as *.gz,
// and files.txt: one line a file, "path type", in the order in which they are embedded.
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import { methodTypes } from "./method_types.mjs";

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

const made = await build({
  absWorkingDir: here,
  entryPoints: { main: "src/main.ts" },
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  charset: "utf8",
  outdir: "dist",
  write: false,
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
  const name = file.path.endsWith(".css") ? "main.css" : "main.js";
  const hash = createHash("sha256").update(file.contents).digest("hex").slice(0, 12);
  const named = `assets/${name.replace(".", `-${hash}.`)}`;
  page = page.replace(`/assets/${name}`, `/${named}`);
  keep(named, name.endsWith(".css") ? "text/css; charset=utf-8" : "text/javascript; charset=utf-8", Buffer.from(file.contents));
}
keep("icon.svg", "image/svg+xml", readFileSync(join(here, "icon.svg")));
keep("index.html", "text/html; charset=utf-8", Buffer.from(page));
writeFileSync(join(out, "files.txt"), files.map(({ path, type }) => `${path}\t${type}\n`).join(""));
const sum_kib = files.reduce((sum, { packed }) => sum + packed, 0) / 1024;
console.log(`page: ${files.length} files, ${sum_kib.toFixed(1)} KiB compressed`);
