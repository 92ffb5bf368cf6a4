// Sleep and wake, and clocks that are wrong: what is told of the past is not taken for the present.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join, relative } from "node:path";
import { afterEach, test } from "node:test";
import { letTimersGo, passTime, stopTimers } from "./stopped_timers.ts";
import { onWake, sleptFor_ms } from "../../../daemon/web/src/lib/wake.ts";

declare const WEB_DIR: string;
const kHour_ms = 3600000;
const kNow = Date.now;
let ahead_ms = 0;
afterEach(() => {
  Date.now = kNow;
  ahead_ms = 0;
  letTimersGo();
});

test("a sleep is what the day has gone on for while timers stood still", () => {
  assert.equal(sleptFor_ms({ clock_ms: 1000, running_ms: 10 }, { clock_ms: 1000 + kHour_ms, running_ms: 2010 }), kHour_ms - 2000);
  assert.equal(sleptFor_ms({ clock_ms: 1000, running_ms: 10 }, { clock_ms: 61000, running_ms: 60010 }), 0, "a hidden tab is looked after seldom, and did not sleep");
  assert.equal(sleptFor_ms({ clock_ms: kHour_ms, running_ms: 10 }, { clock_ms: 0, running_ms: 2010 }), 0, "a clock that was put back");
});

test("waking is told once, with how long it was; a wrong day is not", () => {
  stopTimers();
  Date.now = () => kNow() + ahead_ms;
  ahead_ms = 24 * kHour_ms;  // as it always was
  const slept: number[] = [];
  const end = onWake((slept_ms) => slept.push(slept_ms));
  passTime(10000);
  assert.deepEqual(slept, []);
  ahead_ms += kHour_ms;
  passTime(2000);
  passTime(10000);
  assert.equal(slept.length, 1);
  assert.ok(Math.abs((slept[0] ?? 0) - kHour_ms) < 1000, String(slept[0]));
  ahead_ms += 1000;
  passTime(2000);
  assert.equal(slept.length, 1, "a clock that is corrected by a second");
  end();
  ahead_ms += kHour_ms;
  passTime(10000);
  assert.equal(slept.length, 1);
});

// Times of the daemon are shown as they are; ages come from the daemon, or are counted from when something was told.
test("nothing but the look for a sleep asks this computer's clock for the day", () => {
  const sources = (folder: string): string[] => readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    (entry.isDirectory() ? sources(join(folder, entry.name)) : entry.name.endsWith(".ts") ? [join(folder, entry.name)] : []));
  const root = join(WEB_DIR, "src");
  const asking = sources(root).filter((path) => /\bDate\.now\b|\bnew Date\(\s*\)|\bDate\(\s*\)/.test(readFileSync(path, "utf8")));
  assert.deepEqual(asking.map((path) => relative(root, path)), [join("lib", "wake.ts")]);
});
