// What a button needs, and what hinders: rules alone, so that they are tested.
import type { Topics } from "../../live/live.ts";
import { type Role, mayAs } from "../../rpc/session.ts";

export interface Asked {
  role: Role;
  control?: boolean;  // must have control, not only be let by nobody's having it
  still?: boolean;    // the devices must not be a job's
}

export interface Seen {
  online: boolean;
  hasToken: boolean;
  role: Role;
  who: string;
  control: Topics["control"];
  state: Topics["state"];
}

export type Refusal = "offline" | "token" | "role" | "control_other" | "control_none" | "job" | "";

// Another tab of the same token has the same rights: the daemon knows callers by their tokens.
export const isMine = (seen: Pick<Seen, "control" | "who">): boolean =>
  seen.control !== null && seen.control.owner !== "" && seen.control.who === seen.who;

export function refusalOf(asked: Asked, seen: Seen): Refusal {
  if (!seen.online) return "offline";
  if (!mayAs(seen.role, asked.role)) return seen.hasToken ? "role" : "token";
  if (asked.control && !isMine(seen)) return seen.control?.owner ? "control_other" : "control_none";
  if (asked.still && seen.state?.acquiring) return "job";
  return "";
}
