// Control that this tab has taken: renewed on whatever page, until it is given back, taken away, or the tab closes.
import { within } from "../lib/patience.ts";
import { createStore } from "../lib/store.ts";
import { moment, onWake } from "../lib/wake.ts";
import { type Topics, topics } from "../live/live.ts";
import { ownerName } from "./owner_name.ts";
import { RpcError, call, kOffline } from "./rpc.ts";
import { session } from "./session.ts";

const kLease_s = 60;
const kRenew_ms = 20000;
const kAnswer_ms = 15000;  // a connection that died answers nothing, and the next renewal must not wait for it
const kOvertaken_ms = 2000;
const kLate_ms = 5000;  // hidden tabs have their timers once a minute, which is no sleep

export const isHeldHere = createStore(false);
// Why the last renewal failed; null = it did not.
export const renewalFault = createStore<unknown>(null);

let timer: ReturnType<typeof setInterval> | undefined;

// Counts presses. What was asked for before the newest one counts no more, however late it is answered.
let wish = 0;

interface Acquisition {
  abort: AbortController;
  ended: Promise<unknown>;
}
const underWay = new Set<Acquisition>();

function letGo(): void {
  clearInterval(timer);
  isHeldHere.set(false);
}

// Somebody else has it, or this tab may not have it any more; whatever else goes wrong may be over at the next renewal.
const isLost = (error: unknown): boolean =>
  error instanceof RpcError && (["busy", "no_control", "not_allowed"].includes(error.error) || error.code === 401);

// The answer is newer than what the stream has told.
const tell = (control: NonNullable<Topics["control"]>): void => topics.update((all) => ({ ...all, control }));

// False: another press came meanwhile, and neither answer nor error is for anybody.
async function acquire(force: boolean, mine: number): Promise<boolean> {
  const abort = new AbortController();
  const params = { owner: ownerName(session.get().who), lease_s: kLease_s, ...(force ? { force } : {}) };
  const answer = within(kAnswer_ms, (signal) => call("control.acquire", params, { signal }), abort.signal);
  const acquisition = { abort, ended: answer.catch(() => undefined) };
  underWay.add(acquisition);
  try {
    const control = await answer;
    if (wish !== mine) return false;
    tell(control);
    return true;
  } catch (error) {
    if (wish !== mine) return false;
    throw error instanceof RpcError ? error : new RpcError(kOffline, "offline", String(error));
  } finally {
    underWay.delete(acquisition);
  }
}

export async function takeControl(force: boolean): Promise<void> {
  const mine = ++wish;
  if (!(await acquire(force, mine))) return;
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
    // Of the newest press: one that took nothing, as where it was lost, must not hide what becomes of the renewals.
    acquire(false, wish).then((counts) => {
      if (counts) renewalFault.set(null);
    }, (error: unknown) => {
      renewalFault.set(error);
      if (isLost(error)) letGo();
    });
  }, kRenew_ms);
}

// What was answered the daemon has dealt with. What is not answered in time is given up: at worst it holds until its time is over.
async function acquisitionsEnd(): Promise<void> {
  const patience = setTimeout(() => underWay.forEach(({ abort }) => abort.abort()), kOvertaken_ms);
  await Promise.all([...underWay].map(({ ended }) => ended));
  clearTimeout(patience);
}

export async function giveControlBack(): Promise<void> {
  const mine = ++wish;
  letGo();
  // A renewal that is under way must not overtake the release.
  await acquisitionsEnd();
  if (wish !== mine) return;
  const control = await call("control.release", {});
  if (wish === mine) tell(control);
}

// As the tab goes, or who it was: nobody waits for the answer.
export function leaveControl(): void {
  if (!isHeldHere.get() && underWay.size === 0) return;
  ++wish;
  letGo();  // a browser may bring the page back as it was
  for (const { abort } of underWay) abort.abort();
  void call("control.release", {}, { keepalive: true }).catch(() => undefined);
}

// Somebody took it away, or this tab is somebody else now: then it is not ours to renew.
export function watchControl(): () => void {
  const look = (): void => {
    const { control } = topics.get();
    if (isHeldHere.get() && control !== null && control.owner !== "" && control.who !== session.get().who) letGo();
  };
  // Control that ran out in sleep is not taken again without a press.
  const woken = (slept_ms: number): void => {
    if (slept_ms > 1000 * kLease_s) letGo();
  };
  const ends = [topics.watch(look), session.watch(look), onWake(woken)];
  addEventListener("pagehide", leaveControl);
  return () => {
    for (const end of ends) end();
    removeEventListener("pagehide", leaveControl);
  };
}
