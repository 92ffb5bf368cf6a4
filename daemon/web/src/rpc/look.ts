// Calls that only look, put together: those of one moment go as one request.
import { whileHere } from "../lib/visit.ts";
import type { Methods } from "./methods.ts";
import { RpcError, ask, call, kOffline } from "./rpc.ts";

const kMost = 16;  // of a batch, by the daemon's rules

interface Wanted {
  method: string;
  params: unknown;
  resolve(result: unknown): void;
  reject(error: unknown): void;
}

interface Answer {
  id?: unknown;
  result?: unknown;
  error?: { code: number; message: string; data?: Record<string, unknown> };
}

let waiting: Wanted[] = [];

export function look<M extends keyof Methods>(method: M, params: Methods[M]["params"]): Promise<Methods[M]["result"]> {
  return new Promise((resolve, reject) => {
    if (waiting.length === 0) setTimeout(flush, 0);
    waiting.push({ method, params, resolve: resolve as (result: unknown) => void, reject });
  });
}

function flush(): void {
  const all = waiting;
  waiting = [];
  for (let at = 0; at < all.length; at += kMost) {
    const some = all.slice(at, at + kMost);
    const [only] = some;
    if (only && some.length === 1) call(only.method as keyof Methods, only.params as never).then(only.resolve, only.reject);
    else void together(some);
  }
}

async function together(wanted: readonly Wanted[]): Promise<void> {
  try {
    const body = wanted.map(({ method, params }, id) => ({ jsonrpc: "2.0", id, method, params }));
    const { response, answers } = await whileHere(async (signal) => {
      const reply = await ask("/api/jsonrpc", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(body),
        cache: "no-store",
        signal,
      });
      return { response: reply, answers: (await reply.json().catch(() => null)) as unknown };
    }).catch((error: unknown) => {
      throw new RpcError(kOffline, "offline", String(error));
    });
    if (!response.ok || !Array.isArray(answers)) throw new RpcError(response.status, "no_json", `HTTP ${response.status}`);
    settle(wanted, answers as Answer[]);
  } catch (error) {
    for (const { reject } of wanted) reject(error);
  }
}

function settle(wanted: readonly Wanted[], answers: readonly Answer[]): void {
  const byId = new Map(answers.map((answer) => [answer.id, answer]));
  wanted.forEach(({ resolve, reject }, id) => {
    const answer = byId.get(id);
    if (answer?.error) {
      const { code, message, data } = answer.error;
      reject(new RpcError(code, String(data?.["error"] ?? code), message, data ?? {}));
    } else if (answer) {
      resolve(answer.result);
    } else {
      reject(new RpcError(kOffline, "offline", "a batch lacks an answer"));
    }
  });
}
