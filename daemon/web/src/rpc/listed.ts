// Members of the daemon's lists, as its description types them.
import type { Methods } from "./methods.ts";

export type JobFilter = Methods["job.list"]["params"];
export type JobRow = Methods["job.list"]["result"]["jobs"][number];
export type ValuePoint = Methods["value.list"]["result"]["points"][number];
export type Alarm = Methods["alarm.list"]["result"]["alarms"][number];
