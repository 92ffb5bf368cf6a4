// How long a scan lasts yet, from how fast its slices came so far.
export interface Mark {
  at_ms: number;
  slices: number;
}

// null while too few slices are there to tell.
export function secondsLeft(marks: readonly Mark[], planned: number): number | null {
  const first = marks.find(({ slices }) => slices > 0);
  const last = marks[marks.length - 1];
  if (!first || !last || last.slices - first.slices < 2 || last.at_ms <= first.at_ms) return null;
  const perSlice_ms = (last.at_ms - first.at_ms) / (last.slices - first.slices);
  return Math.max(0, planned - last.slices) * perSlice_ms / 1000;
}

// Marks with the newest added; those of an earlier job are dropped by the caller.
export function marked(marks: readonly Mark[], at_ms: number, slices: number): readonly Mark[] {
  const last = marks[marks.length - 1];
  return last && last.slices === slices ? marks : [...marks, { at_ms, slices }];
}

// z of the newest slice as the recipe plans it; null where the recipe does not tell.
export function plannedZ_um(scan: unknown, slices_done: number): number | null {
  const { start_um, step_um, slices, direction } = (scan ?? {}) as Record<string, unknown>;
  if (typeof start_um !== "number" || typeof step_um !== "number" || typeof slices !== "number" || slices < 1 || slices_done < 1) return null;
  const index = (slices_done - 1) % slices;  // of the scan that runs, where a job has several
  return start_um + step_um * (direction === "down" ? slices - 1 - index : index);
}
