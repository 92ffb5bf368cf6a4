// A kiosk's address has its token behind "#" (fvdctl kiosk-url makes it): browsers never send that part.
import { place } from "../lib/router.ts";
import { createStore } from "../lib/store.ts";
import { leaveControl } from "./held_control.ts";
import { setToken, token, tokenChoices } from "./rpc.ts";
import { logIn } from "./session.ts";

// Null: there is none.
export function tokenIn(hash: string): string | null {
  const token = new URLSearchParams(hash.replace(/^#/, "")).get("token");
  return token === null || token.trim() === "" ? null : token.trim();
}

// Takes it out of the address, so that it stands on no screen and in no bookmark.
function takeOut(): string | null {
  const found = tokenIn(location.hash);
  if (found !== null) history.replaceState(history.state, "", location.pathname + location.search);
  return found;
}

export function takeTokenFromAddress(): void {
  const found = takeOut();
  if (found !== null) setToken(found);
}

// Why the token that was put into the address of the open page was not taken; null = it was, or there was none.
export const addressFault = createStore<unknown>(null);

// An address that differs behind "#" alone loads nothing: who pastes it into an open tab shall be logged in all the same.
// A token that is refused leaves the tab who it was.
export function watchAddress(): () => void {
  let asking: AbortController | null = null;
  const look = (): void => {
    const found = takeOut();
    if (found === null) return;
    asking?.abort();
    const mine = new AbortController();
    asking = mine;
    addressFault.set(null);
    logIn(found, mine.signal, () => {
      if (found !== token.get()) leaveControl();  // nobody could take it before its time is over
    }).catch((error: unknown) => {
      if (!mine.signal.aborted) addressFault.set(error);
    });
  };
  // Who logs in or out meanwhile has the last word; a late refusal of who the tab was has none.
  const changed = (): void => {
    asking?.abort();
    addressFault.set(null);
  };
  const ends = [tokenChoices.watch(changed), place.watch(() => addressFault.set(null))];
  addEventListener("hashchange", look);
  return () => {
    asking?.abort();
    for (const end of ends) end();
    removeEventListener("hashchange", look);
  };
}
