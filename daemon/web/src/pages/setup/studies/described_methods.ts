// The daemon's own description of its methods, fetched once a tab and only by who needs it.
import { call } from "../../../rpc/rpc.ts";
import type { Method } from "./study_fields.ts";

let asked: Promise<Method[]> | null = null;

export function describedMethods(): Promise<Method[]> {
  asked ??= call("rpc.discover", {}).then((told) => (told as unknown as { methods: Method[] }).methods);
  asked.catch(() => (asked = null));
  return asked;
}
