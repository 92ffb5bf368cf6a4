// Where the stage was seen last. Answers tell the place; nothing is asked to find it out.
import { createStore } from "../../../lib/store.ts";

export interface Place {
  z_um: number;
  at_ms: number;  // of performance.now()
}

export const stagePlace = createStore<Place | null>(null);

export function sawStageAt(z_um: unknown): void {
  if (typeof z_um === "number" && Number.isFinite(z_um)) stagePlace.set({ z_um, at_ms: performance.now() });
}
