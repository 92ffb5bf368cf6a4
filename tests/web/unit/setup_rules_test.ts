// Who may press what, where the stage stands, what the journal, the plots and the sparklines show.
import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";
import { type Seen, isMine, refusalOf } from "../../../daemon/web/src/pages/setup/access_rules.ts";
import { type Accuracy, rowsOf } from "../../../daemon/web/src/pages/setup/devices/accuracy_rows.ts";
import { pathOf } from "../../../daemon/web/src/pages/setup/devices/sparkline_path.ts";
import { newest } from "../../../daemon/web/src/pages/setup/journal/newest_alarms.ts";
import { limitsOf, shareOf } from "../../../daemon/web/src/pages/setup/motion/stage_limits.ts";

const nobody = { owner: "", who: "", remaining_s: 0, yours: false };
const mine = { owner: "page", who: "token setter", remaining_s: 60, yours: false };
const other = { owner: "plc", who: "address 10.0.0.7", remaining_s: 60, yours: false };
const seen = (change: Partial<Seen>): Seen =>
  ({ online: true, hasToken: true, role: "set_up", who: "token setter", control: mine, state: null, ...change });

test("a motion needs a connection, a role and control", () => {
  const asked = { role: "set_up", control: true, still: true } as const;
  assert.equal(refusalOf(asked, seen({})), "");
  assert.equal(refusalOf(asked, seen({ online: false })), "offline");
  assert.equal(refusalOf(asked, seen({ role: "operate" })), "role");
  assert.equal(refusalOf(asked, seen({ role: "none", hasToken: false })), "token");
  assert.equal(refusalOf(asked, seen({ control: nobody })), "control_none");
  assert.equal(refusalOf(asked, seen({ control: other })), "control_other");
  assert.equal(refusalOf(asked, seen({ control: null })), "control_none");
  assert.equal(refusalOf(asked, seen({ state: { acquiring: true } as Seen["state"] })), "job");
  assert.equal(refusalOf({ role: "operate" }, seen({ control: other })), "");
});

test("control is mine by the token, not by the name that somebody gave", () => {
  assert.equal(isMine({ control: mine, who: "token setter" }), true);
  assert.equal(isMine({ control: mine, who: "token admin" }), false);
  assert.equal(isMine({ control: nobody, who: "" }), false);
});

test("the narrower soft limits hold", () => {
  const stage = { open: true, min_um: -500, max_um: 500 };
  const objectives = [{ name: "20x", min_um: -100, max_um: 900 }, { name: "5x" }];
  assert.deepEqual(limitsOf(stage, objectives, "20x"), { min_um: -100, max_um: 500 });
  assert.deepEqual(limitsOf(stage, objectives, "5x"), { min_um: -500, max_um: 500 });
  assert.deepEqual(limitsOf({ open: true }, objectives, "20x"), { min_um: -100, max_um: 900 });
  assert.equal(limitsOf({ open: true }, objectives, ""), null);
  const oneSided = [{ name: "50x", min_um: -20 }];
  assert.deepEqual(limitsOf(stage, oneSided, "50x"), { min_um: -20, max_um: 500 });
  assert.equal(limitsOf({ open: true }, oneSided, "50x"), null, "the other end is not known");
  assert.equal(limitsOf(undefined, undefined, ""), null);
  assert.equal(limitsOf({ min_um: 5, max_um: 5 }, [], ""), null);
});

test("a place on the scale stays on the scale", () => {
  const limits = { min_um: -100, max_um: 100 };
  assert.equal(shareOf(0, limits), 0.5);
  assert.equal(shareOf(-100, limits), 0);
  assert.equal(shareOf(101, limits), 1);
});

const alarm = (number: number, level: "warning" | "error" | "critical" = "warning") =>
  ({ number, level, time_utc: "2026-11-30T12:00:00Z", last_utc: "2026-11-30T12:00:00Z", text: "", count: 1, acknowledged: false });

test("the journal has the newest 200, the newest first", () => {
  const many = Array.from({ length: 250 }, (_, i) => alarm(i + 1));
  const shown = newest(many, "all");
  assert.equal(shown.length, 200);
  assert.equal(shown[0]?.number, 250);
  assert.deepEqual(newest([alarm(1), alarm(2, "error")], "error").map(({ number }) => number), [2]);
  assert.equal(many[0]?.number, 1, "the list itself is not turned round");
});

test("curves fill their picture; a constant is a line in its middle", () => {
  assert.equal(pathOf([[0, 0], [10, 1]], 100, 20), "0.0,18.0 100.0,2.0");
  assert.equal(pathOf([[0, 5], [10, 5]], 100, 20), "0.0,10.0 100.0,10.0");
});

test("a stage that does not see its place has times, and no errors", () => {
  const none = { error_mean_um: null, error_sd_um: null, error_max_um: null, error_p95_um: null,
    increment_error_mean_um: null, increment_error_sd_um: null, increment_error_max_um: null };
  const names = { position: "position", step: "step", time: "time", p95: "p95", max: "max" };
  const times = { scans: 1, steps: 20, lost_steps: 0, observable: false, move_p50_ms: 60, move_p95_ms: 70, move_max_ms: 80 };
  assert.deepEqual(rowsOf({ ...times, ...none } as Accuracy, names).map(({ name }) => name), ["time"]);
  const all = rowsOf({ ...times, ...none, error_mean_um: 0.01, error_sd_um: 0.02, error_p95_um: 0.04, error_max_um: 0.05 } as Accuracy, names);
  assert.deepEqual(all[0], { name: "position", unit: "µm", middle: 0.01, spread: 0.02, marks: [["p95", 0.04], ["max", 0.05]] });
});
