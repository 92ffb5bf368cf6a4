// What is remembered of the devices' health while a tab is open.
import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";
import { healthHistory, numbersOf, remember, rememberHealth, seriesOf } from "../../../daemon/web/src/live/health_history.ts";
import { topics } from "../../../daemon/web/src/live/live.ts";

test("health becomes numbers by path", () => {
  assert.deepEqual(numbersOf({ open: true, disk: { free_bytes: 5 }, temperatures_c: { motor: 38.5 }, names: ["a"], none: null }),
    { "disk.free_bytes": 5, "temperatures_c.motor": 38.5 });
});

const health = (requests: number) => ({ ok: true, stalled_threads: [], camera: {}, stage: { requests } });

test("one sample a second is remembered, and not for ever", () => {
  let samples = remember([], health(1), 0);
  samples = remember(samples, health(2), 400);
  assert.equal(samples.length, 1);
  assert.equal(samples[0]?.values["stage.requests"], 2);
  for (let i = 1; i <= 700; ++i) samples = remember(samples, health(2 + i), i * 1000);
  assert.equal(samples.length, 600);
  assert.equal(remember(samples, null, 1e9).length, 600);
});

test("counters are shown by what they grew a second, and never below 0", () => {
  let samples = remember([], health(10), 0);
  samples = remember(samples, health(30), 2000);
  samples = remember(samples, health(0), 3000);
  assert.deepEqual(seriesOf(samples, "stage.requests", true), [[2, 10], [3, 0]]);
  assert.deepEqual(seriesOf(samples, "stage.requests", false), [[0, 10], [2, 30], [3, 0]]);
  assert.deepEqual(seriesOf(samples, "disk.free_bytes", false), []);
});

test("it is remembered as it is told, whichever page is open; what is not of health is no sample", () => {
  const end = rememberHealth();
  topics.update((all) => ({ ...all, health: health(3) }));
  assert.deepEqual(healthHistory.get().map(({ values }) => values), [{ "stage.requests": 3 }]);
  const before = healthHistory.get();
  topics.update((all) => ({ ...all, alarms: [] }));
  assert.equal(healthHistory.get(), before);
  end();
  topics.update((all) => ({ ...all, health: health(4) }));
  assert.equal(healthHistory.get(), before);
});
