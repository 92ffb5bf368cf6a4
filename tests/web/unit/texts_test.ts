// The message files: both languages have every text, every text is used, and every text that is used is there.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import de from "../../../daemon/web/src/i18n/de.json" with { type: "json" };
import en from "../../../daemon/web/src/i18n/en.json" with { type: "json" };

declare const WEB_DIR: string;
const english = en as Record<string, string>;
const german = de as Record<string, string>;

function sources(folder: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return sources(path);
    return entry.name.endsWith(".ts") && entry.name !== "methods.ts" ? [readFileSync(path, "utf8")] : [];
  });
}
const source = sources(join(WEB_DIR, "src")).join("\n");

const placeholders = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name ?? "").sort();

test("both languages have the same texts", () => {
  assert.deepEqual(Object.keys(english).filter((key) => !(key in german)), [], "not in German");
  assert.deepEqual(Object.keys(german).filter((key) => !(key in english)), [], "not in English");
  assert.deepEqual([...Object.entries(english), ...Object.entries(german)].filter(([, text]) => text.trim() === ""), [], "empty");
});

test("both languages put the same values into a text", () => {
  for (const [key, text] of Object.entries(english)) assert.deepEqual(placeholders(german[key] ?? ""), placeholders(text), key);
});

test("every text is used", () => {
  // Keys that are put together begin with a prefix that stands in the sources: tWord("role", …), or `unit.${…}`.
  const prefixes = [
    ...[...source.matchAll(/tWord\(\s*"([\w.]+)"/g)].map(([, prefix]) => `${prefix}.`),
    ...[...source.matchAll(/`(\w+\.[\w.]*)\$\{/g)].map(([, prefix]) => prefix ?? ""),
    ...[...source.matchAll(/"(\w+\.[\w.]*)"\s*\+/g)].map(([, prefix]) => prefix ?? ""),
  ].filter((prefix) => prefix.length > 1);
  const unused = Object.keys(english).filter((key) => !source.includes(`"${key}"`) && !prefixes.some((prefix) => key.startsWith(prefix)));
  assert.deepEqual(unused, []);
});

test("every text that is asked for is there", () => {
  const asked = [...source.matchAll(/\bt\(\s*"([\w.]+)"/g)].map(([, key]) => key ?? "");
  assert.ok(asked.length > 50);
  assert.deepEqual(asked.filter((key) => !(key in english)), []);
});

test("micrometres are written with their sign", () => {
  for (const [key, text] of [...Object.entries(english), ...Object.entries(german)]) {
    assert.doesNotMatch(text, /\d ?um\b|\(um\b|\}\s?um\b|\bum\/s|\bmum\b/, key);
  }
});
