// How far the stage may go, as the daemon tells it.

export interface Limits {
  min_um: number;
  max_um: number;
}

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);

// One end may be missing: an objective may limit the stage at one side alone.
function endsOf(about: unknown): { low: number; high: number } {
  const { min_um, max_um } = (about ?? {}) as Record<string, unknown>;
  return { low: isNumber(min_um) ? min_um : -Infinity, high: isNumber(max_um) ? max_um : Infinity };
}

// The confirmed objective's limits hold inside the stage's own. Null: the daemon did not tell both ends; it holds them anyhow.
export function limitsOf(stage: unknown, objectives: unknown, confirmed: string): Limits | null {
  const list = Array.isArray(objectives) ? (objectives as Record<string, unknown>[]) : [];
  const all = [stage, list.find((each) => each["name"] === confirmed)].map(endsOf);
  const [min_um, max_um] = [Math.max(...all.map(({ low }) => low)), Math.min(...all.map(({ high }) => high))];
  return Number.isFinite(min_um) && Number.isFinite(max_um) && min_um < max_um ? { min_um, max_um } : null;
}

// Where a position lies on a scale of limits: 0 at the lower end, 1 at the upper.
export function shareOf(z_um: number, { min_um, max_um }: Limits): number {
  return Math.min(1, Math.max(0, (z_um - min_um) / (max_um - min_um)));
}
