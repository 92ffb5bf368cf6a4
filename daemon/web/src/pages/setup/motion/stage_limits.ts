// How far the stage may go, as the daemon tells it.

export interface Limits {
  min_um: number;
  max_um: number;
}

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);

function limitsIn(about: unknown): Limits | null {
  const { min_um, max_um } = (about ?? {}) as Record<string, unknown>;
  return isNumber(min_um) && isNumber(max_um) && min_um < max_um ? { min_um, max_um } : null;
}

// The confirmed objective's limits hold inside the stage's own. Null: the daemon told neither; it holds them anyhow.
export function limitsOf(stage: unknown, objectives: unknown, confirmed: string): Limits | null {
  const own = limitsIn(stage);
  const list = Array.isArray(objectives) ? (objectives as Record<string, unknown>[]) : [];
  const narrower = limitsIn(list.find((each) => each["name"] === confirmed));
  if (own === null || narrower === null) return narrower ?? own;
  return { min_um: Math.max(own.min_um, narrower.min_um), max_um: Math.min(own.max_um, narrower.max_um) };
}

// Where a position lies on a scale of limits: 0 at the lower end, 1 at the upper.
export function shareOf(z_um: number, { min_um, max_um }: Limits): number {
  return Math.min(1, Math.max(0, (z_um - min_um) / (max_um - min_um)));
}
