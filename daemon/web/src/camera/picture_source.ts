// Pictures for the eye, one after another. Who operates has one taken; who looks on sees what the daemon shows anyhow.
import { within } from "../lib/patience.ts";
import { whileHere } from "../lib/visit.ts";
import type { Methods } from "../rpc/methods.ts";
import { ask, call } from "../rpc/rpc.ts";

export type PictureParams = Methods["camera.preview"]["params"];

export interface Picture {
  seq: number;
  blob: Blob;
  width_px: number;
  height_px: number;
  z_um: number | null;
  focus: number | null;
  saturated_fraction: number | null;
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const kPatience_ms = 20000;  // a connection that died in sleep or with a cable answers nothing, for minutes

// The commands of this tab wait for it.
export const takePicture = (params: PictureParams, outer: AbortSignal): Promise<Picture> => within(kPatience_ms, async (signal) => {
  const { seq, width_px, height_px, z_um, focus, saturated_fraction, png_base64 } = await call("camera.preview", params, { signal });
  return { seq, width_px, height_px, z_um, focus, saturated_fraction, blob: new Blob([bytesOf(png_base64)], { type: "image/png" }) };
}, outer);

// Null: none within the daemon's patience.
export const awaitPicture = (after: number, outer: AbortSignal): Promise<Picture | null> => within(kPatience_ms, (either) => whileHere(async (signal) => {
  const response = await ask(`/api/v1/preview.jpg?after=${after}`, { signal, cache: "no-store" });
  if (response.status === 204) return null;
  if (!response.ok) throw new Error(`HTTP ${response.status}`);
  const told = (name: string): number | null => {
    const text = response.headers.get(name);
    const value = text === null || text === "" ? NaN : Number(text);
    return Number.isFinite(value) ? value : null;
  };
  return {
    seq: told("X-Fvd-Seq") ?? after + 1,
    blob: await response.blob(),
    width_px: told("X-Fvd-Width-Px") ?? 0,
    height_px: told("X-Fvd-Height-Px") ?? 0,
    z_um: told("X-Fvd-Z-Um"),
    focus: told("X-Fvd-Focus"),
    saturated_fraction: told("X-Fvd-Saturated-Fraction"),
  };
}, either), outer);
