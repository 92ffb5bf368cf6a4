// Which alarms the journal shows.
import type { Alarm } from "../../../rpc/listed.ts";

const kMost = 200;

export function newest(alarms: readonly Alarm[], level: string): Alarm[] {
  return alarms.filter((alarm) => level === "all" || alarm.level === level).sort((a, b) => b.number - a.number).slice(0, kMost);
}
