// Calls of the daemon: the same dispatcher, errors and audit as for every other client.
import { createStore } from "../lib/store.ts";
import { whileHere } from "../lib/visit.ts";
import type { Methods } from "./methods.ts";

export class RpcError extends Error {
  constructor(
    readonly code: number,
    readonly error: string,  // its stable name, as "no_control"
    message: string,
    readonly data: Record<string, unknown> = {},
  ) {
    super(message);
  }
}

// kOffline stands for: nobody answered.
export const kOffline = -1;

const kTokenKey = "fvd.token";

// The token belongs to this tab, and is forgotten with it.
export const token = createStore<string | null>(sessionStorage.getItem(kTokenKey));

// The token that this tab had is nobody's, or nobody's any more; until another one is given, or nobody wants one.
export const tokenWasRefused = createStore(false);

// How often somebody has said who this tab is; a refusal is nobody's word.
export const tokenChoices = createStore(0);

function keep(text: string | null): void {
  if (text === null) sessionStorage.removeItem(kTokenKey);
  else sessionStorage.setItem(kTokenKey, text);
  tokenWasRefused.set(false);
  token.set(text);
}

export function setToken(text: string | null): void {
  keep(text);
  tokenChoices.update((count) => count + 1);
}

// Each further call with it would be refused too, and later each time.
export function refuseToken(given: string | null): void {
  if (given === null || given !== token.get()) return;
  keep(null);
  tokenWasRefused.set(true);
}

// These are sent, and waited for, also as the page is left.
const kAlways: ReadonlySet<string> = new Set(["stage.stop", "job.abort", "control.release"]);

let lastId = 0;

interface Reply {
  result?: unknown;
  error?: { code: number; message: string; data?: Record<string, unknown> };
}

export function headers(): Record<string, string> {
  const given = token.get();
  return given === null ? {} : { Authorization: `Bearer ${given}` };
}

// A request of this tab, or of whom `init` says; the tab's own token is forgotten where it is refused.
export async function ask(path: string, init: Omit<RequestInit, "headers"> & { headers?: Record<string, string> }): Promise<Response> {
  const given = token.get();
  const response = await fetch(path, { ...init, headers: { ...headers(), ...init.headers } });
  if (response.status === 401 && init.headers?.["Authorization"] === undefined) refuseToken(given);
  return response;
}

export async function call<M extends keyof Methods>(
  method: M,
  params: Methods[M]["params"],
  options: { signal?: AbortSignal; keepalive?: boolean; token?: string } = {},
): Promise<Methods[M]["result"]> {
  const id = ++lastId;
  const send = async (signal?: AbortSignal): Promise<{ response: Response; text: string }> => {
    const response = await ask("/api/jsonrpc", {
      method: "POST",
      headers: {
        "Content-Type": "application/json",
        ...(options.token === undefined ? {} : { Authorization: `Bearer ${options.token}` }),
      },
      body: JSON.stringify({ jsonrpc: "2.0", id, method, params }),
      cache: "no-store",
      ...(signal ? { signal } : {}),
      ...(options.keepalive ? { keepalive: true } : {}),
    });
    return { response, text: await response.text() };
  };
  let answer: Awaited<ReturnType<typeof send>>;
  try {
    answer = kAlways.has(method) ? await send(options.signal) : await whileHere(send, options.signal);
  } catch (error) {
    if (options.signal?.aborted) throw error;
    throw new RpcError(kOffline, "offline", String(error));
  }
  const { response, text } = answer;
  let reply: Reply & { error?: unknown; message?: unknown };
  try {
    reply = JSON.parse(text);
  } catch {
    throw new RpcError(response.status, "no_json", `HTTP ${response.status}`);
  }
  if (!response.ok) throw new RpcError(response.status, String(reply.error), String(reply.message));
  if (reply.error) {
    const { code, message, data } = reply.error as NonNullable<Reply["error"]>;
    throw new RpcError(code, String(data?.["error"] ?? code), message, data ?? {});
  }
  return reply.result as Methods[M]["result"];
}
