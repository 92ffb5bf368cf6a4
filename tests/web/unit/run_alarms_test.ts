// What an operator can do about an alarm, which is a line of the log.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { drawn } from "./small_document.ts";
import en from "../../../daemon/web/src/i18n/en.json" with { type: "json" };
import { loadTexts } from "../../../daemon/web/src/i18n/i18n.ts";
import { html } from "../../../daemon/web/src/lib/html.ts";
import { topics } from "../../../daemon/web/src/live/live.ts";
import { AlarmsPanel } from "../../../daemon/web/src/pages/run/alarms_panel.ts";
import { errorCodeIn, saidOnce } from "../../../daemon/web/src/run/error_in_text.ts";

declare const WEB_DIR: string;
const { "x-errors": errors } = JSON.parse(readFileSync(join(WEB_DIR, "openrpc.json"), "utf8")) as { "x-errors": { code: number; name: string }[] };

before(() => loadTexts("en"));

test("an error is known by the daemon's name for it, wherever the line has it", () => {
  assert.equal(errorCodeIn("job 20261130-1 failed: stage_alarm: the drive raised alarm 7: see: its manual"), 1115);
  assert.equal(errorCodeIn("stage_disconnected: no answer from 192.168.0.5"), 1111);
  assert.equal(errorCodeIn("no job is taken: storage_full: 12 MiB are free"), 1131);
  for (const text of ["the disk is nearly full", "stage_alarm", "not_an_error: stage", "my_stage_alarm: no", "constructor: x", ""]) assert.equal(errorCodeIn(text), 0, text);
});

test("each error for which there is a text is found by its name, and by no other", () => {
  const withText = errors.filter(({ code }) => `run.todo.${code}` in en);
  assert.ok(withText.length > 15);
  assert.equal(withText.length, Object.keys(en).filter((key) => key.startsWith("run.todo.")).length, "a text for an error that the daemon has not");
  for (const { code, name } of errors) assert.equal(errorCodeIn(`job J failed: ${name}: why`), withText.some((each) => each.code === code) ? code : 0, name);
});

test("an alarm says what to do about its error, another one what its level asks for", () => {
  const alarm = (number: number, text: string) => ({ number, time_utc: "2026-11-30T10:00:00.000Z", last_utc: "2026-11-30T10:00:00.000Z", level: "error" as const, text, count: 1, acknowledged: false });
  topics.update((all) => ({ ...all, alarms: [alarm(1, "job J failed: stage_alarm: alarm 7"), alarm(2, "something else")] }));
  const [newest, older] = drawn(html`<${AlarmsPanel}/>`).all("li");
  assert.ok(newest?.text.includes(en["run.alarm_todo.error"]));
  assert.ok(older?.text.includes(en["run.todo.1115"]));
});

test("a stop that somebody pressed is a notice, and says its word once", () => {
  assert.equal(saidOnce("job J aborted: aborted: the axis was asked to stop"), "job J aborted: the axis was asked to stop");
  assert.equal(saidOnce("job J failed: stage_alarm: alarm 7"), "job J failed: stage_alarm: alarm 7");
  const alarm = (text: string, level: "warning" | "error") => ({ number: 1, time_utc: "2026-11-30T10:00:00.000Z", last_utc: "2026-11-30T10:00:00.000Z", level, text, count: 1, acknowledged: false });
  const draw = (text: string, level: "warning" | "error") => {
    topics.update((all) => ({ ...all, alarms: [alarm(text, level)] }));
    return drawn(html`<${AlarmsPanel}/>`);
  };
  const wanted = draw("job J aborted: aborted: the axis was asked to stop", "warning");
  assert.equal(wanted.all(".alarm-notice").length, 1);
  assert.ok(wanted.text.includes(en["run.alarm_level.notice"]) && !wanted.text.includes("aborted: aborted"));
  assert.equal(wanted.all(".waiting").length, 0);
  for (const text of ["job J failed: stage_alarm: alarm 7", "job J aborted: stage_alarm: alarm 7"]) {
    const fault = draw(text, "error");
    assert.deepEqual([fault.all(".alarm-error").length, fault.all(".waiting").length], [1, 1], text);
  }
  // The daemon saw it rest a moment later, and then it is a warning there.
  const restless = draw("job J aborted: aborted: the axis was asked to stop; standstill was not confirmed: the axis still moves; it took the stop", "warning");
  assert.deepEqual([restless.all(".alarm-notice").length, restless.all(".waiting").length], [0, 1]);
});
