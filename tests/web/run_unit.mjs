// Bundles each unit/NAME_test.ts with the page's own sources and runs all of them under node's test runner.
// node tests/web/run_unit.mjs [NAME ...] : those whose names contain one of the words; none = all.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const { build } = createRequire(join(here, "../../daemon/web/package.json"))("esbuild");
const words = process.argv.slice(2);
const wanted = readdirSync(join(here, "unit")).filter(
  (name) => name.endsWith("_test.ts") && (words.length === 0 || words.some((word) => name.includes(word))));
const out = mkdtempSync(join(tmpdir(), "fvd-web-unit-"));
let status = 1;
try {
  await build({
    entryPoints: wanted.map((name) => join(here, "unit", name)),
    outdir: out, outExtension: { ".js": ".mjs" }, bundle: true, format: "esm", platform: "node", target: "node18",
    sourcemap: "inline", logLevel: "warning", nodePaths: [join(here, "../../daemon/web/node_modules")],
  });
  const files = wanted.map((name) => join(out, name.replace(/\.ts$/, ".mjs")));
  status = files.length === 0 ? 1 : spawnSync(process.execPath, ["--test", ...files], { stdio: "inherit" }).status ?? 1;
} finally {
  rmSync(out, { recursive: true, force: true });
}
process.exit(status);
