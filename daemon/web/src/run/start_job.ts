// Starts jobs under this page's numbers. The same number of the same client is the same job, never a second motion: so
// a request whose answer was lost is repeated as it was.
import { within } from "../lib/patience.ts";
import { moment } from "../lib/wake.ts";
import type { Methods } from "../rpc/methods.ts";
import { RpcError, kOffline } from "../rpc/rpc.ts";

// All tabs count together: the daemon knows the newest number, and each tab's session tells its requests apart.
export const kClient = "page";

const kConflict = 1009;
const kStale = 1010;
const kInterrupted = 1014;
const kRepeats = 3;
const kBetween_ms = 500;
const kPatience_ms = 2000;
// From a press to what is sent for it: all repeats take 10 s. Where it took longer this computer slept, and nobody knows who
// stands at the machine now.
const kLongest_ms = 15000;

export interface Calls {
  start(params: Methods["job.start"]["params"], signal: AbortSignal): Promise<Methods["job.start"]["result"]>;
  newest(): Promise<number>;
  wait(duration_ms: number): Promise<void>;
}

export interface Starter {
  // The newest number as it is known: asked for ahead, so that a press need not wait for it.
  know(newest: number): void;
  forget(): void;
  start(part_id: string, recipe: string): Promise<Methods["job.start"]["result"]>;
  // A start that was pressed is not sent, and not repeated, any more: after a stop nothing may begin by itself.
  cancel(): void;
}

// Nobody answered, or who answered was not fvd: the request may have arrived.
const isLost = (error: unknown): boolean => !(error instanceof RpcError) || [kOffline, 502, 503, 504].includes(error.code);

export function createStarter(calls: Calls, session: string): Starter {
  let newest: number | null = null;
  let cancels = 0;

  const repeated = async (params: Methods["job.start"]["params"], isOver: () => boolean): Promise<Methods["job.start"]["result"]> => {
    for (let attempt = 0; ; ++attempt) {
      try {
        return await within(kPatience_ms, (signal) => calls.start(params, signal));
      } catch (error) {
        if (!isLost(error)) throw error;
        if (attempt >= kRepeats || isOver()) throw new RpcError(kOffline, "offline", String(error));
        await calls.wait(kBetween_ms);
        if (isOver()) throw new RpcError(kOffline, "offline", String(error));
      }
    }
  };

  const start = async (part_id: string, recipe: string): Promise<Methods["job.start"]["result"]> => {
    const before = cancels;
    const begun_ms = moment().clock_ms;
    const isOver = (): boolean => cancels !== before || moment().clock_ms - begun_ms > kLongest_ms;
    for (let attempt = 0; ; ++attempt) {
      newest ??= await calls.newest();
      if (isOver()) throw new RpcError(kOffline, "offline", "the start came too late");
      const seq = newest + 1;
      try {
        const started = await repeated({ seq, part_id, recipe, client: kClient, session }, isOver);
        newest = Math.max(newest ?? 0, seq);
        return started;
      } catch (error) {
        // Whatever it was, the number is asked for anew before the next part.
        newest = null;
        const isTaken = error instanceof RpcError && [kConflict, kStale, kInterrupted].includes(error.code);
        if (!isTaken || attempt > 0 || isOver()) throw error;
      }
    }
  };

  return {
    know: (known) => {
      if (newest === null || known > newest) newest = known;
    },
    forget: () => {
      newest = null;
    },
    cancel: () => {
      ++cancels;
    },
    start,
  };
}

// Random letters; crypto.randomUUID is not there on pages that come over plain HTTP from another machine.
export function newSession(): string {
  return [...crypto.getRandomValues(new Uint8Array(12))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
