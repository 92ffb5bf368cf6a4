// Part ids: what is accepted, how they count on, and which keys are a scanner's.
import assert from "node:assert/strict";
import test from "node:test";
import { nextPartId, partIdProblem } from "../../../daemon/web/src/run/part_ids.ts";
import { kNoScan, takeKey } from "../../../daemon/web/src/run/scanner.ts";

test("a part id is 1 to 64 printable ASCII characters", () => {
  assert.equal(partIdProblem(""), "empty");
  assert.equal(partIdProblem("a"), "none");
  assert.equal(partIdProblem("<script>alert(1)</script>"), "none");
  assert.equal(partIdProblem("x".repeat(64)), "none");
  assert.equal(partIdProblem("x".repeat(65)), "long");
  assert.equal(partIdProblem("x".repeat(200)), "long");
  for (const bad of ["שלום", "Stück", "a\tb", "a\nb", "\u007f", "a\u202eb"]) assert.equal(partIdProblem(bad), "characters", bad);
});

test("the next number keeps the width, and what stands around it", () => {
  assert.equal(nextPartId("part-0041"), "part-0042");
  assert.equal(nextPartId("A9"), "A10");
  assert.equal(nextPartId("999"), "1000");
  assert.equal(nextPartId("7-left"), "8-left");
  assert.equal(nextPartId("2026-11-30 #08b"), "2026-11-30 #09b");
  assert.equal(nextPartId("12345678901234567890123"), "12345678901234567890124");
});

test("without a number before, the next one is still a part id", () => {
  assert.equal(nextPartId(""), "part-0001");
  assert.equal(nextPartId("left"), "left-2");
  assert.equal(nextPartId("שלום"), "part-0001");
  assert.equal(nextPartId("x".repeat(64)), `${"x".repeat(62)}-2`);
  assert.equal(nextPartId("9".repeat(64)), "0".repeat(64));
  assert.equal(partIdProblem(nextPartId("y".repeat(64))), "none");
});

function type(text: string, gap_ms: number): (string | null)[] {
  let scan = kNoScan;
  return [...text].map((character, i) => {
    const step = takeKey(scan, character === "\n" ? "Enter" : character, 1000 + i * gap_ms);
    scan = step.next;
    return step.scanned;
  });
}

test("keys that come as fast as a scanner's, with Enter, are a code", () => {
  assert.deepEqual(type("AB-17\n", 8).at(-1), "AB-17");
  assert.deepEqual(type("AB 17 \n", 35).at(-1), "AB 17 ");
});

test("what a person types is none", () => {
  assert.deepEqual(type("AB-17\n", 60).at(-1), null);
  assert.deepEqual(type("a\n", 5).at(-1), null, "one key and Enter may be two fingers");
  assert.deepEqual(type("\n", 5).at(-1), null);
});

test("Shift between the letters does not end a code, a pause begins a new one", () => {
  let step = takeKey(kNoScan, "x", 0);
  step = takeKey(step.next, "a", 500);
  step = takeKey(step.next, "Shift", 505);
  assert.equal(step.isBurst, false);
  step = takeKey(step.next, "B", 510);
  step = takeKey(step.next, "c", 520);
  assert.equal(step.isBurst, true, "the third fast key is no person's");
  step = takeKey(step.next, "Enter", 530);
  assert.deepEqual(step, { next: kNoScan, isBurst: true, scanned: "aBc" });
});
