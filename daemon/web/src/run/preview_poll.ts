// The live picture: one request at a time, each for a picture newer than the last.
import { pause, within } from "../lib/patience.ts";
import { createStore } from "../lib/store.ts";
import { whileHere } from "../lib/visit.ts";
import { ask } from "../rpc/rpc.ts";

export interface Picture {
  seq: number;
  width_px: number;   // of the camera's image, which the picture may be smaller than
  height_px: number;
  z_um: number;       // NaN where it was not told
  focus: number;
  saturated_fraction: number;
  bitmap: ImageBitmap;
}

// none: nothing takes pictures now; missing: this fvd serves none; refused: not to this caller; offline: nobody answers.
export type PreviewStatus = "waiting" | "picture" | "none" | "missing" | "refused" | "offline";

// Where the stage was at the newest picture, for who shows it elsewhere.
export const pictured = createStore<{ z_um: number; at_ms: number } | null>(null);

const kAfterNone_ms = 500;
const kAfterMissing_ms = 30000;
const kAfterFault_ms = 1000;
const kPatience_ms = 20000;  // a connection that died in sleep or with a cable answers nothing, for minutes

const headerNumber = (response: Response, name: string): number => {
  const text = response.headers.get(name);
  return text === null || text.trim() === "" ? NaN : Number(text);
};

async function pictureOf(response: Response): Promise<Picture> {
  const bitmap = await createImageBitmap(await response.blob());
  const number = (name: string, otherwise: number): number => {
    const value = headerNumber(response, name);
    return Number.isFinite(value) ? value : otherwise;
  };
  return {
    bitmap,
    seq: number("X-Fvd-Seq", 0),
    width_px: number("X-Fvd-Width-Px", bitmap.width),
    height_px: number("X-Fvd-Height-Px", bitmap.height),
    z_um: number("X-Fvd-Z-Um", NaN),
    focus: number("X-Fvd-Focus", NaN),
    saturated_fraction: number("X-Fvd-Saturated-Fraction", NaN),
  };
}

// Begins to ask; call the result to end it. A page that nobody looks at asks for nothing.
export function watchPreview(show: (picture: Picture) => void, tell: (status: PreviewStatus) => void): () => void {
  const abort = new AbortController();
  let after = 0;

  const once = async (signal: AbortSignal): Promise<number> => {
    const response = await ask(`/api/v1/preview.jpg?after=${after}`, { cache: "no-store", signal });
    if (response.status === 200) {
      const picture = await pictureOf(response);
      if (abort.signal.aborted) return 0;
      after = picture.seq;
      pictured.set(Number.isFinite(picture.z_um) ? { z_um: picture.z_um, at_ms: performance.now() } : null);
      tell("picture");
      show(picture);
      return 0;
    }
    if (response.status === 204) {
      // The daemon may have been started anew meanwhile, and count from one again.
      after = 0;
      tell("none");
      return kAfterNone_ms;
    }
    tell(response.status === 404 || response.status === 405 ? "missing" : response.status < 500 ? "refused" : "offline");
    return response.status === 404 ? kAfterMissing_ms : kAfterFault_ms;
  };

  const loop = async (): Promise<void> => {
    while (!abort.signal.aborted) {
      let pause_ms: number;
      try {
        if (document.visibilityState === "visible") pause_ms = await within(kPatience_ms, (signal) => whileHere(once, signal), abort.signal);
        else pause_ms = kAfterFault_ms;
      } catch {
        if (abort.signal.aborted) return;
        tell("offline");
        after = 0;
        pause_ms = kAfterFault_ms;
      }
      if (pause_ms > 0) await pause(pause_ms, abort.signal);
    }
  };
  void loop();
  return () => abort.abort();
}
