import assert from "node:assert/strict";
import test from "node:test";
import { askNewest } from "../../../daemon/web/src/lib/newest.ts";
import { readNumber } from "../../../daemon/web/src/lib/read_number.ts";

test("both decimal signs are read, separators of thousands and words are not", () => {
  assert.equal(readNumber("1,5"), 1.5);
  assert.equal(readNumber(" -1.5 "), -1.5);
  assert.equal(readNumber("−3"), -3);
  assert.equal(readNumber("1e-3"), 0.001);
  assert.deepEqual([".5", "-,5", "3."].map(readNumber), [0.5, -0.5, 3]);
  for (const text of ["", " ", ".", "1,5,2", "1,000.5", "1.000,5", "1 2", "12 µm", "0x10", "1e999", "NaN", "Infinity", "--1"]) assert.equal(readNumber(text), null, text);
});

test("only the answer to the newest question counts, also when an older one comes later", async () => {
  const waiting: ((answer: string) => void)[] = [];
  const taken: string[] = [];
  let done = (): void => undefined;
  const asker = askNewest(
    (_question: string) => new Promise<string>((resolve) => waiting.push(resolve)),
    (answer) => {
      taken.push(answer);
      done();
    },
    () => assert.fail("no failure"),
    0,
  );
  const asked = async (count: number): Promise<void> => { while (waiting.length < count) await new Promise((resolve) => setImmediate(resolve)); };
  asker.ask("first");
  await asked(1);
  asker.ask("second");
  await asked(2);
  const end = new Promise<void>((resolve) => { done = resolve; });
  waiting[1]?.("of the second");
  await end;
  waiting[0]?.("of the first");
  await new Promise((resolve) => setImmediate(resolve));
  assert.deepEqual(taken, ["of the second"]);
});
