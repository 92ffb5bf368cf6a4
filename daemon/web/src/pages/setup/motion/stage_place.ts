// Where the stage was seen last, and how far it may go. Answers tell the place; nothing is asked to find it out.
import { createStore } from "../../../lib/store.ts";

export interface Place {
  z_um: number;
  at_ms: number;  // of performance.now()
}

export interface Limits {
  min_um: number;
  max_um: number;
}

export const stagePlace = createStore<Place | null>(null);

export function sawStageAt(z_um: unknown): void {
  if (typeof z_um === "number" && Number.isFinite(z_um)) stagePlace.set({ z_um, at_ms: performance.now() });
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
