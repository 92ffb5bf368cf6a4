// Unit tests of the operator page's pure functions: each *_test.ts is bundled, and Node's own runner runs it.
//
// node tests/web/run_unit.mjs [NAME ...] : all tests, or those whose file names contain a NAME. Needs `npm ci` in daemon/web.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const web = join(here, "../../daemon/web");
const { build } = createRequire(join(web, "package.json"))("esbuild");

const wanted = process.argv.slice(2);
const tests = readdirSync(join(here, "unit"))
  .filter((name) => name.endsWith("_test.ts") && (wanted.length === 0 || wanted.some((part) => name.includes(part))))
  .sort();
if (tests.length === 0) {
  console.error(`no test's file name contains ${wanted.join(", ")}`);
  process.exit(1);
}

const out = mkdtempSync(join(tmpdir(), "fvd-web-unit-"));
let status = 1;
try {
  await build({
    entryPoints: tests.map((name) => join(here, "unit", name)),
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    outdir: out,
    outExtension: { ".js": ".mjs" },
    // What a page imports from the packages is found beside the page, not beside the test.
    nodePaths: [join(web, "node_modules")],
    loader: { ".css": "empty" },
    sourcemap: "inline",
    logLevel: "warning",
    define: { WEB_DIR: JSON.stringify(web) },
  });
  const files = tests.map((name) => join(out, name.replace(/\.ts$/, ".mjs")));
  status = spawnSync(process.execPath, ["--enable-source-maps", "--test", ...files], { stdio: "inherit" }).status ?? 1;
} finally {
  rmSync(out, { recursive: true, force: true });
}
process.exit(status);
