// Control of the station, kept for as long as this tab wants it. It ends by itself a minute after the tab is gone.
import { createStore } from "../lib/store.ts";
import { RpcError, call, token } from "./rpc.ts";

const kLease_s = 60;
const kRenew_ms = 20000;
const kOwner = "page";

// True while this tab renews its control.
export const keepsControl = createStore(false);

let timer: ReturnType<typeof setInterval> | undefined;

function stopKeeping(): void {
  clearInterval(timer);
  keepsControl.set(false);
}

async function renew(): Promise<void> {
  try {
    await call("control.acquire", { owner: kOwner, lease_s: kLease_s });
  } catch (error) {
    // An unanswered renewal is tried again: the daemon may be restarting. A refused one means somebody else has it.
    if (error instanceof RpcError && (error.error === "no_control" || error.error === "not_allowed" || error.code === 401)) stopKeeping();
  }
}

// With force control is taken from who has it; that needs the role "administer".
export async function takeControl(force = false): Promise<void> {
  await call("control.acquire", { owner: kOwner, lease_s: kLease_s, force });
  clearInterval(timer);
  timer = setInterval(() => void renew(), kRenew_ms);
  keepsControl.set(true);
}

export async function releaseControl(): Promise<void> {
  stopKeeping();
  await call("control.release", {});
}

// Another caller's token is another caller: what this tab held is not his.
token.watch(stopKeeping);
