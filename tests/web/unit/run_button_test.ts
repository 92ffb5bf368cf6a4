// The one button: what it is in each state, why it may not be pressed, and second clicks.
import assert from "node:assert/strict";
import test from "node:test";
import { type Situation, isSlip, oneButton } from "../../../daemon/web/src/run/button_rules.ts";

const good: Situation = {
  isLinked: true, state: { state: "ready", ready: true }, mayOperate: true, mayTryStop: true, hasAnotherControl: false, partProblem: "none", hasRecipe: true,
};
const at = (change: Partial<Situation>) => oneButton({ ...good, ...change });

test("START where the machine takes jobs", () => {
  assert.deepEqual(at({}), { action: "start", why: null });
  assert.deepEqual(at({ state: { state: "initialized", ready: true } }), { action: "start", why: null });
});

test("STOP while something is executed, whoever has control and whatever is typed", () => {
  const state = { state: "executing", ready: false };
  assert.deepEqual(at({ state }), { action: "stop", why: null });
  assert.deepEqual(at({ state, hasAnotherControl: true, partProblem: "long", hasRecipe: false }), { action: "stop", why: null });
  assert.deepEqual(at({ state, isLinked: false }), { action: "stop", why: null }, "a stop is tried without a stream of events too");
  assert.deepEqual(at({ state, mayOperate: false }), { action: "stop", why: null }, "who this tab is may not be known yet");
  assert.deepEqual(at({ state, mayOperate: false, mayTryStop: false }), { action: "stop", why: "no_role" });
});

test("RESET in an error", () => {
  const state = { state: "error", ready: false };
  assert.deepEqual(at({ state, partProblem: "empty", hasRecipe: false }), { action: "reset", why: null });
  assert.deepEqual(at({ state, mayOperate: false }), { action: "reset", why: "no_role" });
  assert.deepEqual(at({ state, isLinked: false }), { action: "reset", why: "link" });
});

test("every reason against a start, the one that hinders most first", () => {
  assert.equal(at({ isLinked: false, mayOperate: false }).why, "link");
  assert.equal(at({ state: null }).why, "unknown");
  assert.equal(at({ mayOperate: false, hasAnotherControl: true }).why, "no_role");
  assert.equal(at({ state: { state: "preoperational", ready: false } }).why, "preoperational");
  assert.equal(at({ state: { state: "halted", ready: false } }).why, "halted");
  assert.equal(at({ hasAnotherControl: true, partProblem: "empty" }).why, "control");
  assert.equal(at({ hasRecipe: false }).why, "recipe");
  assert.equal(at({ partProblem: "empty" }).why, "part_empty");
  assert.equal(at({ partProblem: "long" }).why, "part_long");
  assert.equal(at({ partProblem: "characters" }).why, "part_characters");
  assert.equal(at({ state: { state: "ready", ready: false } }).why, "not_ready");
});

test("the second click of a double click does not mean something else", () => {
  assert.equal(isSlip(null, "start", 0), false);
  assert.equal(isSlip({ action: "start", at_ms: 1000 }, "stop", 1200), true);
  assert.equal(isSlip({ action: "start", at_ms: 1000 }, "stop", 1400), false, "a wanted stop is not kept waiting");
  assert.equal(isSlip({ action: "stop", at_ms: 1000 }, "start", 2100), true, "a frightened hand does not begin anew");
  assert.equal(isSlip({ action: "stop", at_ms: 1000 }, "start", 2300), false);
  assert.equal(isSlip({ action: "stop", at_ms: 1000 }, "stop", 1001), false, "stop twice is stop");
});
