// What is drawn of the stage's accuracy; a stage that does not see its place has no errors to show.
import type { Methods } from "../../../rpc/methods.ts";

export type Accuracy = Methods["stage.accuracy"]["result"];

export interface Row {
  name: string;
  unit: string;
  middle: number;
  spread: number | null;  // one standard deviation to either side
  marks: [string, number][];
}

const asNumber = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);

export function rowsOf(accuracy: Accuracy, names: { position: string; step: string; time: string; p95: string; max: string }): Row[] {
  const rows: Row[] = [];
  const row = (name: string, unit: string, middle: unknown, spread: unknown, marks: [string, unknown][]): void => {
    const value = asNumber(middle);
    if (value === null) return;
    rows.push({ name, unit, middle: value, spread: asNumber(spread),
      marks: marks.flatMap(([mark, at]): [string, number][] => (asNumber(at) === null ? [] : [[mark, asNumber(at) ?? 0]])) });
  };
  row(names.position, "µm", accuracy.error_mean_um, accuracy.error_sd_um, [[names.p95, accuracy.error_p95_um], [names.max, accuracy.error_max_um]]);
  row(names.step, "µm", accuracy.increment_error_mean_um, accuracy.increment_error_sd_um, [[names.max, accuracy.increment_error_max_um]]);
  row(names.time, "ms", accuracy.move_p50_ms, null, [[names.p95, accuracy.move_p95_ms], [names.max, accuracy.move_max_ms]]);
  return rows;
}
