// A held button repeats; a hand that is gone sends nothing more, whatever the line does.
import assert from "node:assert/strict";
import test from "node:test";
import { type Direction, JogHold } from "../../../daemon/web/src/pages/setup/motion/jog_hold.ts";

// A line and a clock of the test's own: nothing here waits.
class Line {
  now_ms = 0;
  slept_ms = 0;  // in which timers stood still
  sent: { at_ms: number; direction: Direction }[] = [];
  ends: unknown[] = [];
  answers: { resolve: () => void; reject: (error: unknown) => void }[] = [];
  answersAtOnce = true;
  #timers = new Map<number, { at_ms: number; call: () => void }>();
  #last = 0;

  readonly hold = new JogHold({
    send: (direction, signal) => {
      this.sent.push({ at_ms: this.now_ms, direction });
      if (this.answersAtOnce) return Promise.resolve();
      return new Promise((resolve, reject) => {
        this.answers.push({ resolve, reject });
        signal.addEventListener("abort", () => reject(new Error("aborted")));
      });
    },
    isTransient: (error) => (error as Error).message === "busy",
    ended: (error) => this.ends.push(error),
    setTimer: (call, after_ms) => {
      this.#timers.set(++this.#last, { at_ms: this.now_ms + after_ms, call });
      return this.#last;
    },
    clearTimer: (timer) => this.#timers.delete(timer as number),
    now_ms: () => this.now_ms + this.slept_ms,
  });

  get pending(): number {
    return this.#timers.size;
  }

  async pass(for_ms: number): Promise<void> {
    const until_ms = this.now_ms + for_ms;
    for (;;) {
      await settled();
      const next = [...this.#timers].filter(([, { at_ms }]) => at_ms <= until_ms).sort(([, a], [, b]) => a.at_ms - b.at_ms)[0];
      if (!next) break;
      this.#timers.delete(next[0]);
      this.now_ms = next[1].at_ms;
      next[1].call();
    }
    this.now_ms = until_ms;
    await settled();
  }
}

const settled = async (): Promise<void> => {
  for (let i = 0; i < 10; ++i) await Promise.resolve();
};

test("a held button repeats every 100 ms, the first time at once", async () => {
  const line = new Line();
  line.hold.begin("up");
  await line.pass(350);
  assert.deepEqual(line.sent.map(({ at_ms }) => at_ms), [0, 100, 200, 300]);
  assert.ok(line.sent.every(({ direction }) => direction === "up"));
});

test("nothing is sent after the end", async () => {
  const line = new Line();
  line.hold.begin("down");
  await line.pass(150);
  line.hold.end();
  const sent = line.sent.length;
  await line.pass(5000);
  assert.equal(line.sent.length, sent);
  assert.equal(line.pending, 0);
  assert.deepEqual(line.ends, [undefined]);
  assert.equal(line.hold.direction, null);
});

test("an end without a begin does nothing, and a second end neither", () => {
  const line = new Line();
  line.hold.end();
  line.hold.begin("up");
  line.hold.end();
  line.hold.end();
  assert.equal(line.ends.length, 1);
});

test("on a slow line repeats do not pile up", async () => {
  const line = new Line();
  line.answersAtOnce = false;
  line.hold.begin("up");
  await line.pass(450);
  assert.equal(line.sent.length, 1, "one is under way");
  line.answers[0]?.resolve();
  await settled();
  assert.equal(line.sent.length, 2, "the next one was due and goes at once");
});

test("an answer that comes after the end begins nothing", async () => {
  const line = new Line();
  line.answersAtOnce = false;
  line.hold.begin("up");
  await line.pass(250);
  line.hold.end();
  line.answers[0]?.resolve();
  await line.pass(1000);
  assert.equal(line.sent.length, 1);
});

test("an error ends it and is told once", async () => {
  const line = new Line();
  line.answersAtOnce = false;
  line.hold.begin("up");
  const limit = new Error("at the limit");
  line.answers[0]?.reject(limit);
  await line.pass(1000);
  assert.deepEqual(line.ends, [limit]);
  assert.equal(line.sent.length, 1);
});

test("busy devices are tried again before a jog has begun, not after", async () => {
  const line = new Line();
  line.answersAtOnce = false;
  line.hold.begin("up");
  line.answers[0]?.reject(new Error("busy"));
  await line.pass(25);
  assert.equal(line.sent.length, 2);
  line.answers[1]?.resolve();
  await line.pass(100);
  assert.equal(line.sent.length, 3);
  line.answers[2]?.reject(new Error("busy"));
  await line.pass(1000);
  assert.equal(line.sent.length, 3);
  assert.equal((line.ends[0] as Error).message, "busy");
});

test("the other direction ends the first", async () => {
  const line = new Line();
  line.hold.begin("up");
  await line.pass(50);
  line.hold.begin("down");
  await line.pass(150);
  assert.deepEqual(line.sent.map(({ direction }) => direction), ["up", "down", "down"]);
  assert.equal(line.ends.length, 1);
});

test("a sleep with a held button ends the jog: nobody knows where the hand is", async () => {
  const line = new Line();
  line.hold.begin("up");
  await line.pass(250);
  line.slept_ms = 60000;
  await line.pass(1000);
  assert.deepEqual(line.sent.map(({ at_ms }) => at_ms), [0, 100, 200]);
  assert.deepEqual(line.ends, [undefined]);
  assert.equal(line.hold.direction, null);
  line.hold.begin("up");
  await line.pass(150);
  assert.equal(line.sent.length, 5, "the next press is one again");
});

test("an answer that took a second is followed by no repeat", async () => {
  const line = new Line();
  line.answersAtOnce = false;
  line.hold.begin("up");
  await line.pass(50);
  line.slept_ms = 1200;
  line.answers[0]?.resolve();
  await line.pass(200);
  assert.equal(line.sent.length, 1);
  assert.equal(line.ends.length, 1);
});
