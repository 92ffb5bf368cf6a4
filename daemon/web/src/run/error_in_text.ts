// Which error an alarm tells of. Alarms are lines of the daemon's log, which writes an error's stable name before its
// message: "job J failed: stage_alarm: …". Here are those for which an operator can do something.
const kCodes: Record<string, number> = {
  aborted: 1012, interrupted: 1014,
  camera_disconnected: 1101, camera_frames_lost: 1102, camera_settings: 1104, camera_no_frames: 1105,
  stage_disconnected: 1111, stage_limit: 1112, stage_not_homed: 1113, stage_position: 1114, stage_alarm: 1115, stage_taken: 1116,
  focus_range_insufficient: 1121, too_few_valid_points: 1122, bad_slice: 1123, slice_lost: 1124,
  storage_full: 1131, storage_write_failed: 1132, db_failed: 1133,
  region_outside: 1142, objective_mismatch: 1146, memory_budget: 1203,
};

// "job J aborted: aborted: why": the state has the error's name, which is said once.
export const saidOnce = (text: string): string => text.replace(/(^| )([a-z_]+): \2: /, "$1$2: ");

// What somebody wanted is no fault, though the log has it beside those.
// An end that was not only wanted is an error by its level, or says that the stage was not seen to rest after its stop.
export const isWanted = ({ level, text }: { level: string; text: string }): boolean =>
  level === "warning" && errorCodeIn(text) === kCodes["aborted"] && !text.includes("standstill was not confirmed");

// 0 = none of them.
export function errorCodeIn(text: string): number {
  for (const [, name = ""] of text.matchAll(/(?:^| )([a-z_]+)(?=: )/g)) if (Object.hasOwn(kCodes, name)) return kCodes[name] ?? 0;
  return 0;
}
