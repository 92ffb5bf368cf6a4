// Exposure and gain that pictures, snaps and the focus search are taken with: typed here once.
import { readNumber } from "../../../lib/read_number.ts";
import { createStore } from "../../../lib/store.ts";

export interface Light {
  exposure_us: string;  // as typed; empty = as the camera has it, or the recipe
  gain_db: string;
  recipe: string;
}

export const light = createStore<Light>({ exposure_us: "", gain_db: "", recipe: "" });

export interface LightParams {
  exposure_us?: number;
  gain_db?: number;
  recipe?: string;
}

export function lightParams({ exposure_us, gain_db, recipe }: Light): LightParams {
  const params: LightParams = {};
  const exposure = readNumber(exposure_us);
  const gain = readNumber(gain_db);
  if (exposure !== null) params.exposure_us = exposure;
  if (gain !== null) params.gain_db = gain;
  if (recipe !== "") params.recipe = recipe;
  return params;
}

export const isLight = ({ exposure_us, gain_db }: Light): boolean =>
  [exposure_us, gain_db].every((text) => text.trim() === "" || readNumber(text) !== null);
