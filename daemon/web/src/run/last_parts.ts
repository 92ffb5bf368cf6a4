// The parts that ended last, the newest first.
import type { Verdict } from "./value_rows.ts";

export interface LastPart {
  job_id: string;
  part_id: string;
  state: string;           // completed, failed, aborted
  verdict: Verdict | null;
}

// The list with a part in front; a part that is in it already is replaced where it stands.
export function withPart(parts: readonly LastPart[], part: LastPart, most: number): readonly LastPart[] {
  const at = parts.findIndex(({ job_id }) => job_id === part.job_id);
  if (at >= 0) return parts.map((each, i) => (i === at ? part : each));
  return [part, ...parts].slice(0, most);
}
