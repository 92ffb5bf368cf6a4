// A kiosk's address has its token behind "#" (fvdctl kiosk-url makes it): browsers never send that part.
import { setToken } from "./rpc.ts";

// Null: there is none.
export function tokenIn(hash: string): string | null {
  const token = new URLSearchParams(hash.replace(/^#/, "")).get("token");
  return token === null || token.trim() === "" ? null : token.trim();
}

// Takes it out of the address, so that it stands on no screen and in no bookmark.
export function takeTokenFromAddress(): void {
  const found = tokenIn(location.hash);
  if (found === null) return;
  history.replaceState(history.state, "", location.pathname + location.search);
  setToken(found);
}
