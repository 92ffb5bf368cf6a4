// Control that this tab has taken: renewed on whatever page, until it is given back, taken away, or the tab closes.
import { createStore } from "../lib/store.ts";
import { moment, onWake } from "../lib/wake.ts";
import { type Topics, topics } from "../live/live.ts";
import { ownerName } from "./owner_name.ts";
import { RpcError, call } from "./rpc.ts";
import { session } from "./session.ts";

const kLease_s = 60;
const kRenew_ms = 20000;
const kLate_ms = 5000;  // hidden tabs have their timers once a minute, which is no sleep

export const isHeldHere = createStore(false);
// Why the last renewal failed; null = it did not.
export const renewalFault = createStore<unknown>(null);

let timer: ReturnType<typeof setInterval> | undefined;

function letGo(): void {
  clearInterval(timer);
  isHeldHere.set(false);
}

// Somebody else has it, or this tab may not have it any more; whatever else goes wrong may be over at the next renewal.
const isLost = (error: unknown): boolean =>
  error instanceof RpcError && (["busy", "no_control", "not_allowed"].includes(error.error) || error.code === 401);

// The answer is newer than what the stream has told.
const tell = (control: NonNullable<Topics["control"]>): void => topics.update((all) => ({ ...all, control }));

async function acquire(force: boolean): Promise<void> {
  tell(await call("control.acquire", { owner: ownerName(session.get().who), lease_s: kLease_s, ...(force ? { force } : {}) }));
}

export async function takeControl(force: boolean): Promise<void> {
  await acquire(force);
  renewalFault.set(null);
  clearInterval(timer);
  isHeldHere.set(true);
  let before_ms = moment().clock_ms;
  timer = setInterval(() => {
    const now_ms = moment().clock_ms;
    const since_ms = now_ms - before_ms;
    before_ms = now_ms;
    // Whatever the timers do in a sleep, and whichever of them comes first after it: control that ran out is not taken again.
    if (since_ms > 1000 * kLease_s + kLate_ms) {
      letGo();
      return;
    }
    acquire(false).then(() => renewalFault.set(null), (error: unknown) => {
      renewalFault.set(error);
      if (isLost(error)) letGo();
    });
  }, kRenew_ms);
}

export async function giveControlBack(): Promise<void> {
  letGo();
  tell(await call("control.release", {}));
}

// Somebody took it away, or this tab is somebody else now: then it is not ours to renew.
export function watchControl(): () => void {
  const look = (): void => {
    const { control } = topics.get();
    if (isHeldHere.get() && control !== null && control.owner !== "" && control.who !== session.get().who) letGo();
  };
  const leave = (): void => {
    if (!isHeldHere.get()) return;
    letGo();  // a browser may bring the page back as it was
    void call("control.release", {}, { keepalive: true }).catch(() => undefined);
  };
  // Control that ran out in sleep is not taken again without a press.
  const woken = (slept_ms: number): void => {
    if (slept_ms > 1000 * kLease_s) letGo();
  };
  const ends = [topics.watch(look), session.watch(look), onWake(woken)];
  addEventListener("pagehide", leave);
  return () => {
    for (const end of ends) end();
    removeEventListener("pagehide", leave);
  };
}
