// STOP, from whatever part of the page. What was pressed before it, and waits in this tab yet, is not sent any more.
import { within } from "../lib/patience.ts";
import { createStore } from "../lib/store.ts";
import { moment } from "../lib/wake.ts";
import type { Methods } from "./methods.ts";
import { RpcError, call, kOffline } from "./rpc.ts";

const kPatience_ms = 3000;  // a connection that died answers nothing, for minutes; the next press shall have another one
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

export async function stopStage(): Promise<Methods["stage.stop"]["result"]> {
  stopPresses.update((count) => count + 1);
  try {
    return await within(kPatience_ms, (signal) => call("stage.stop", {}, { signal }));
  } catch (error) {
    throw error instanceof RpcError ? error : new RpcError(kOffline, "offline", String(error));
  }
}
