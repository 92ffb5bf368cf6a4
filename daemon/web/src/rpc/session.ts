// As whom this tab calls.
import { createStore } from "../lib/store.ts";
import { call, setToken, token, tokenWasRefused } from "./rpc.ts";

export type Role = "none" | "view" | "operate" | "set_up" | "administer";

const kOrder: readonly Role[] = ["none", "view", "operate", "set_up", "administer"];

export const session = createStore<{ who: string; role: Role }>({ who: "", role: "none" });

export const mayAs = (role: Role, needed: Role): boolean => kOrder.indexOf(role) >= kOrder.indexOf(needed);

// STOP is not tried by who surely only looks. Who this tab is may be unknown, where the daemon told nothing yet: it decides.
export const mayTryStop = (role: Role): boolean => role !== "view";

export async function lookWhoIAm(): Promise<void> {
  const asked = token.get();
  const { who, role } = await call("session.info", {});
  if (token.get() === asked) session.set({ who, role: role as Role });  // else it is of who this tab was
}

// Throws RpcError with code 401 for a token that nobody has. After the signal's end the tab stays who it is, whatever comes.
// before() is called while the tab is yet who it was.
export async function logIn(text: string, signal: AbortSignal, before: () => void = () => undefined): Promise<void> {
  const { who, role } = await call("session.info", {}, { token: text, signal });
  signal.throwIfAborted();
  before();
  setToken(text);
  session.set({ who, role: role as Role });
}

export async function logOut(): Promise<void> {
  setToken(null);
  session.set({ who: "", role: "none" });  // until fvd says more
  await lookWhoIAm();
}

// A token that was withdrawn meanwhile is forgotten with the first call that it is refused for: then the tab looks on as
// one without. Call the result to end it.
export const watchRefusals = (): (() => void) => tokenWasRefused.watch(() => {
  if (!tokenWasRefused.get()) return;
  session.set({ who: "", role: "none" });  // fvd may say nothing to somebody without a token
  void lookWhoIAm().catch(() => undefined);  // asked again after the next reconnection
});
