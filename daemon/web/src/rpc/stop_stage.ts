// STOP, from whatever part of the page. What was pressed before it, and waits in this tab yet, is not sent any more.
import { pause, within } from "../lib/patience.ts";
import { createStore } from "../lib/store.ts";
import { moment } from "../lib/wake.ts";
import type { Methods } from "./methods.ts";
import { RpcError, call, kOffline } from "./rpc.ts";

const kPatience_ms = 3000;  // a connection that died answers nothing, for minutes; the next press shall have another one
// Of stops that follow by themselves: so long a request may be on its way where the next one already arrives.
const kBetween_ms = 250;
const kMostAgain = 40;
// From a press to what is sent for it. Where it took longer nobody knows who stands at the machine now.
const kLongest_ms = 15000;

// How often it was pressed in this tab.
export const stopPresses = createStore(0);

// To be called at the press of something that moves: tells later whether that may still be sent.
export function sincePress(): () => boolean {
  const before = stopPresses.get();
  const begun_ms = moment().clock_ms;
  return () => stopPresses.get() === before && moment().clock_ms - begun_ms <= kLongest_ms;
}

const kAborted = 1012;
export const tooLate = (): RpcError =>
  new RpcError(kAborted, "aborted", "this was pressed before a stop, or long ago, and had not begun: nothing was moved");

// Motions of this tab that were sent; each signal ends as its motion is answered.
const underWay = new Set<AbortSignal>();

// A command whose answer comes with the end of its motion.
export async function asMotion<T>(work: () => Promise<T>): Promise<T> {
  const answered = new AbortController();
  underWay.add(answered.signal);
  try {
    return await work();
  } finally {
    underWay.delete(answered.signal);
    answered.abort();
  }
}

const send = (): Promise<Methods["stage.stop"]["result"]> => within(kPatience_ms, (signal) => call("stage.stop", {}, { signal }));

// Until a stop finds the motion, or the motion is answered. What is pressed after the press is not meant.
async function stopAgain(motion: AbortSignal): Promise<void> {
  for (let i = 0; i < kMostAgain; ++i) {
    await pause(kBetween_ms, motion);
    if (motion.aborted) return;
    const found = await send().then(({ stopped }) => stopped !== "nothing", () => false);
    if (found) return;
  }
}

export async function stopStage(): Promise<Methods["stage.stop"]["result"]> {
  stopPresses.update((count) => count + 1);
  const motions = [...underWay];
  // On its way a motion may be overtaken by a stop, which then finds nothing or is lost.
  const again = (): void => motions.forEach((motion) => void stopAgain(motion));
  try {
    const told = await send();
    if (told.stopped === "nothing") again();
    return told;
  } catch (error) {
    again();
    throw error instanceof RpcError ? error : new RpcError(kOffline, "offline", String(error));
  }
}
