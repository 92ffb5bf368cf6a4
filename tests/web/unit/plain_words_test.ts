// Small things that people stumble over: signs of nothing, times of a machine, names of counters, rows that lead nowhere.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { drawn } from "./small_document.ts";
import { loadTexts, number } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { utcText } from "../../../daemon/web/src/lib/utc_text.ts";
import { topics } from "../../../daemon/web/src/live/live.ts";
import { JobTable } from "../../../daemon/web/src/pages/history/job_table.ts";
import { ControlPanel } from "../../../daemon/web/src/pages/run/control_panel.ts";
import { DevicesPanel } from "../../../daemon/web/src/pages/run/devices_panel.ts";
import { ValuesPanel } from "../../../daemon/web/src/pages/run/result_panels.ts";
import { isHeldHere } from "../../../daemon/web/src/rpc/held_control.ts";
import { session } from "../../../daemon/web/src/rpc/session.ts";

before(() => loadTexts("en"));

test("nothing has no sign", () => {
  assert.deepEqual([-0.004, -0, 0.004].map((value) => number(value, 2)), ["0.00", "0.00", "0.00"]);
  assert.deepEqual([-0.006, -1].map((value) => number(value, 2)), ["-0.01", "-1.00"]);
  assert.equal(number(-0), "0");
  assert.equal(number(-0.4, 0), "0");
  assert.equal(number(-0.004), "-0.004", "as exact as it is");
});

test("a time is for people, and no time stays what it is", () => {
  assert.equal(utcText("2026-12-01T03:50:47.769Z"), "2026-12-01 03:50:47Z");
  assert.equal(utcText("2026-12-01T03:50:47Z"), "2026-12-01 03:50:47Z");
  for (const text of ["", "soon", "2026-12-01T03:50:47+01:00"]) assert.equal(utcText(text), text);
});

test("what a device went through is told in words", () => {
  const told = (openings: number): string => {
    topics.update((all) => ({ ...all, health: { stage: { open: true, openings, unanswered: 14 } } as never }));
    return drawn(html`<${DevicesPanel}/>`).text;
  };
  assert.match(told(2), /was lost once and came back · requests without an answer: 14/);
  assert.match(told(4), /was lost 3 times and came back/);
});

test("a job is opened by its part as well", () => {
  const row = { job_id: "J 1", seq: 1, client: "page", part_id: "P-003", recipe: "groove", state: "completed", verdict: "pass", ended_utc: "2026-12-01T03:50:47.769Z", error: "" };
  const table = drawn(html`<${JobTable} rows=${[row]} chosen=${[]} onChoose=${() => undefined}/>`);
  assert.deepEqual(table.all("a").filter(({ text }) => text === "P-003").map(({ given }) => given.get("href")), ["/jobs/J%201"]);
});

// Without seconds to count down: a clock that ticks would keep the test alive.
test("control that this tab renews has no end, any other one has", () => {
  session.set({ who: "token anna", role: "operate" });
  topics.update((all) => ({ ...all, control: { owner: "page", who: "token anna", remaining_s: 0 } as never }));
  isHeldHere.set(true);
  const here = drawn(html`<${ControlPanel}/>`).text;
  isHeldHere.set(false);
  const elsewhere = drawn(html`<${ControlPanel}/>`).text;
  assert.match(here, /as long as this page is open/);
  assert.doesNotMatch(here, /unless it is renewed/);
  assert.match(elsewhere, /unless it is renewed/);
});

test("the same part again has a previous scan, another one a previous part", () => {
  const shown = { job_id: "J1", status: { part_id: "P-003", state: "aborted", done: true, client: "other" }, result: null, directory: "", isFinal: true, problem: "" };
  const drawnWhile = (part_id: string): string => {
    topics.update((all) => ({ ...all, job: { job_id: "J2", part_id, done: false } as never }));
    return drawn(html`<${ValuesPanel} shown=${shown}/>`).text;
  };
  assert.match(drawnWhile("P-003"), /previous scan/);
  assert.match(drawnWhile("P-004"), /previous part/);
});
