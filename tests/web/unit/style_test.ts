// Rules of the style sheets that no look at a screen shows.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";

declare const WEB_DIR: string;
const folder = join(WEB_DIR, "src/style");
const sheets = new Map(readdirSync(folder).filter((name) => name.endsWith(".css")).map((name) => [name, readFileSync(join(folder, name), "utf8").replace(/\/\*[^]*?\*\//g, "")]));

// The outermost blocks: what stands before each, and what is in it.
function blocks(css: string): { head: string; body: string }[] {
  const found: { head: string; body: string }[] = [];
  let depth = 0;
  let from = 0;
  let head = "";
  for (let i = 0; i < css.length; ++i) {
    if (css[i] === "{" && depth++ === 0) {
      head = css.slice(from, i).trim();
      from = i + 1;
    } else if (css[i] === "}" && --depth === 0) {
      found.push({ head, body: css.slice(from, i) });
      from = i + 1;
    }
  }
  return found;
}

test("dark colours are for screens: paper is light whatever the page is", () => {
  let dark = 0;
  for (const [name, css] of sheets) {
    for (const { head, body } of blocks(css)) {
      const isDark = /prefers-color-scheme: dark|data-theme="dark"/.test(head + body);
      if (isDark && !/data-ground/.test(body)) {
        assert.match(head, /^@media screen\b/, `${name}: ${head}`);
        ++dark;
      }
    }
  }
  assert.ok(dark >= 4, String(dark));
});

test("what is hidden on paper leaves the report: head, map, profile, values, conditions", () => {
  const paper = [...sheets.values()].flatMap(blocks).filter(({ head }) => head === "@media print").map(({ body }) => body).join("\n");
  const hidden = [...paper.matchAll(/([^{}]+)\{[^}]*display: none[^}]*\}/g)].map(([, selectors]) => selectors ?? "").join(",").split(",").map((each) => each.trim());
  for (const needed of [".result-head", ".map-panel", ".map-stage", ".profile-panel", ".profile-plot", ".colour-bar", ".hole-legend", ".print-only", ".measurements", ".conditions"]) {
    assert.ok(!hidden.some((each) => each === needed || each === `.result-page ${needed}`), `${needed} is hidden`);
  }
  for (const gone of [".top", ".buttons", ".result-page .controls", ".result-page form", ".result-page .screen-only", ".result-page .downloads"]) {
    assert.ok(hidden.includes(gone), `${gone} is on paper`);
  }
  assert.match(paper, /\.result-page \.print-only \{ display: block; \}/);
});
