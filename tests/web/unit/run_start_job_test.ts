// Starting under a number: nothing moves twice, whatever becomes of the answers.
import "./browser_stand_in.ts";
import assert from "node:assert/strict";
import test from "node:test";
import { RpcError, kOffline } from "../../../daemon/web/src/rpc/rpc.ts";
import { createStarter } from "../../../daemon/web/src/run/start_job.ts";

interface Asked { seq: number; part_id: string; recipe?: string; client?: string; session?: string }

// A daemon that gives the next of these answers: a number of an error, "lost", or "ok".
function stand(answers: (number | "ok" | "lost" | "aborted")[], newest: number[]) {
  const asked: Asked[] = [];
  const waits: number[] = [];
  let looks = 0;
  const starter = createStarter({
    start: async (params) => {
      asked.push(params);
      const answer = answers.shift();
      if (answer === "lost") throw new RpcError(kOffline, "offline", "gone");
      if (answer === "aborted") throw Object.assign(new Error("timeout"), { name: "TimeoutError" });
      if (typeof answer === "number") throw new RpcError(answer, "x", "y");
      return { job_id: `job-${params.seq}`, seq: params.seq, client: "page", duplicate: false, state: "processing" };
    },
    newest: async () => {
      ++looks;
      const next = newest.shift();
      if (next === undefined) throw new RpcError(kOffline, "offline", "gone");
      return next;
    },
    wait: async (duration_ms) => void waits.push(duration_ms),
  }, "session-a");
  return { starter, asked, waits, looks: () => looks };
}

test("the number is one more than the newest, which is asked for once", async () => {
  const { starter, asked, looks } = stand(["ok", "ok"], [41]);
  assert.equal((await starter.start("p1", "r")).seq, 42);
  assert.equal((await starter.start("p2", "r")).seq, 43);
  assert.equal(looks(), 1);
  assert.deepEqual(asked[0], { seq: 42, part_id: "p1", recipe: "r", client: "page", session: "session-a" });
});

test("a number that was told ahead needs no question, and an older one does not count back", async () => {
  const { starter, looks } = stand(["ok"], []);
  starter.know(7);
  starter.know(5);
  assert.equal((await starter.start("p", "r")).seq, 8);
  assert.equal(looks(), 0);
});

test("a lost answer: the same request again, with the same number", async () => {
  const { starter, asked, waits } = stand(["lost", "aborted", "ok"], [1]);
  await starter.start("p", "r");
  assert.deepEqual(asked.map(({ seq }) => seq), [2, 2, 2]);
  assert.deepEqual(new Set(asked.map((each) => JSON.stringify(each))).size, 1);
  assert.equal(waits.length, 2);
});

test("who never answers is given up, and the number is asked for anew", async () => {
  const { starter, asked, looks } = stand(["lost", "lost", "lost", "lost", "ok"], [1, 2]);
  await assert.rejects(starter.start("p", "r"), { code: kOffline });
  assert.equal(asked.length, 4);
  assert.equal((await starter.start("p", "r")).seq, 3, "the lost request had arrived: its job is there");
  assert.equal(looks(), 2);
});

test("a start that still asks for its number is not sent after a stop", async () => {
  let cancel = (): void => undefined;
  let asked = 0;
  const starter = createStarter({
    start: async ({ seq }) => {
      ++asked;
      return { job_id: `job-${seq}`, seq, client: "page", duplicate: false, state: "processing" };
    },
    newest: async () => {
      cancel();
      return 1;
    },
    wait: async () => undefined,
  }, "s");
  cancel = starter.cancel;
  await assert.rejects(starter.start("p", "r"), { code: kOffline });
  assert.equal(asked, 0);
});

test("a press of before a sleep starts nothing after it", async () => {
  const now = Date.now;
  let asked = 0;
  let slept_ms = 0;
  Date.now = () => now() + slept_ms;
  const sleeping = (when: "asked" | "waited") => createStarter({
    start: async () => {
      ++asked;
      throw new RpcError(kOffline, "offline", "gone");
    },
    newest: async () => {
      if (when === "asked") slept_ms += 3600000;
      return 1;
    },
    wait: async () => {
      if (when === "waited") slept_ms += 3600000;
    },
  }, "s");
  try {
    await assert.rejects(sleeping("asked").start("p", "r"), { code: kOffline });
    assert.equal(asked, 0);
    await assert.rejects(sleeping("waited").start("p", "r"), { code: kOffline });
    assert.equal(asked, 1);
  } finally {
    Date.now = now;
  }
});

test("after a stop a lost start is not repeated", async () => {
  let cancel = (): void => undefined;
  let asked = 0;
  const starter = createStarter({
    start: async () => {
      ++asked;
      throw new TypeError("the connection broke in the middle of the answer");
    },
    newest: async () => 1,
    wait: async () => cancel(),  // STOP is pressed while the start waits to be repeated
  }, "s");
  cancel = starter.cancel;
  await assert.rejects(starter.start("p", "r"), { code: kOffline });
  assert.equal(asked, 1);
});

test("a number that another tab took: the next one, once", async () => {
  const { starter, asked } = stand([1009, "ok"], [1, 2]);
  assert.equal((await starter.start("p", "r")).seq, 3);
  assert.deepEqual(asked.map(({ seq }) => seq), [2, 3]);
  const again = stand([1009, 1009], [1, 2]);
  await assert.rejects(again.starter.start("p", "r"), { code: 1009 });
});

test("numbers that went stale or were interrupted are left behind", async () => {
  for (const code of [1010, 1014]) {
    const { starter } = stand([code, "ok"], [1, 90]);
    assert.equal((await starter.start("p", "r")).seq, 91);
  }
});

test("a refusal is told and not repeated", async () => {
  for (const code of [1002, 1003, 1004, 1005, -32602]) {
    const { starter, asked } = stand([code], [1]);
    await assert.rejects(starter.start("p", "r"), { code });
    assert.equal(asked.length, 1);
  }
});
