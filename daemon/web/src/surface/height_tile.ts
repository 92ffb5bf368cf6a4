// A piece of a job's map as the daemon sends it: a header of 32 bytes, then planes of float32, row by row from the top.
import { whileHere } from "../lib/visit.ts";
import { RpcError, ask, kOffline } from "../rpc/rpc.ts";

export type Kind = "height" | "sigma" | "texture" | "reason";

// In points of the whole map.
export interface Window {
  x: number;
  y: number;
  w: number;
  h: number;
}

export interface Tile {
  kind: Kind;
  window: Window;
  width: number;  // of the planes
  height: number;
  factor: number;  // each sample stands for a block of so many by so many points
  map_width: number;
  map_height: number;
  mean: Float32Array;  // heights and sigmas in metres, NaN = hole; grey levels; sums of reasons
  lowest: Float32Array;  // the same array as mean where nothing was reduced
  highest: Float32Array;
}

const kHeaderBytes = 32;
// The daemon ignores it. Browsers keep a tile for ever: where its bytes or their meaning change, this changes with them.
const kAddressVersion = "1";
const kMagic = 0x48445646;  // "FVDH", read as a little-endian number

// Throws where the bytes are not what the header promises: half a map must not look like a whole one.
export function parseTile(bytes: ArrayBuffer, kind: Kind, at: { x: number; y: number } = { x: 0, y: 0 }): Tile {
  const view = new DataView(bytes);
  if (bytes.byteLength < kHeaderBytes || view.getUint32(0, true) !== kMagic) throw new Error("height: no map in the reply");
  const word = (i: number): number => view.getUint32(4 * i, true);
  const [version, width, height, factor, planes, map_width, map_height] = [1, 2, 3, 4, 5, 6, 7].map(word) as [
    number, number, number, number, number, number, number];
  if (version !== 1) throw new Error(`height: version ${version} is not known to this page; load it again`);
  if ((planes !== 1 && planes !== 3) || factor < 1 || bytes.byteLength !== kHeaderBytes + 4 * width * height * planes) {
    throw new Error("height: the reply is incomplete");
  }
  const plane = (i: number): Float32Array => new Float32Array(bytes, kHeaderBytes + 4 * width * height * i, width * height);
  const mean = plane(0);
  return {
    kind, width, height, factor, map_width, map_height, mean,
    lowest: planes === 3 ? plane(1) : mean,
    highest: planes === 3 ? plane(2) : mean,
    window: {
      x: at.x, y: at.y,
      w: Math.min(width * factor, map_width - at.x), h: Math.min(height * factor, map_height - at.y),
    },
  };
}

export function tileAddress(job: string, kind: Kind, window: Window | null, most: number): string {
  const query = new URLSearchParams({ kind, max: String(most), v: kAddressVersion });
  if (window) for (const key of ["x", "y", "w", "h"] as const) query.set(key, String(window[key]));
  return `/api/v1/jobs/${encodeURIComponent(job)}/height?${query}`;
}

// most: no side of the reply is longer.
export async function fetchTile(job: string, kind: Kind, window: Window | null, most: number, signal?: AbortSignal): Promise<Tile> {
  let told: { response: Response; bytes: ArrayBuffer | null };
  try {
    told = await whileHere(async (own) => {
      const response = await ask(tileAddress(job, kind, window, most), { signal: own });
      return { response, bytes: response.ok ? await response.arrayBuffer() : null };
    }, signal);
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new RpcError(kOffline, "offline", String(error));
  }
  if (told.bytes === null) throw new RpcError(told.response.status, "no_map", await refusal(told.response));
  return parseTile(told.bytes, kind, window ?? { x: 0, y: 0 });
}

async function refusal(response: Response): Promise<string> {
  const text = await response.text();
  try {
    return String((JSON.parse(text) as { message?: unknown }).message ?? text);
  } catch {
    return `HTTP ${response.status}`;
  }
}
