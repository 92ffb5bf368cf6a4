// Which alarms stand first: those that nobody acknowledged, the newest first.
import type { Alarm } from "../rpc/listed.ts";

export function ordered(alarms: readonly Alarm[]): Alarm[] {
  return [...alarms].sort((a, b) => Number(a.acknowledged) - Number(b.acknowledged) || b.number - a.number);
}

// The time as the workstation's people read it; the text itself where it is no time. Never compared with this browser's clock.
export function timeForPeople(time_utc: string, language: string): string {
  const time = new Date(time_utc);
  if (Number.isNaN(time.getTime())) return time_utc;
  return new Intl.DateTimeFormat(language, { dateStyle: "short", timeStyle: "medium" }).format(time);
}
