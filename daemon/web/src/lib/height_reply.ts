// The reply of /api/v1/jobs/ID/height: a header of 32 bytes, then float32; see the daemon's README.
export interface HeightReply {
  width: number;    // of the body
  height: number;
  factor: number;   // side of the block of map pixels that makes a sample
  map_width: number;
  map_height: number;
  values: Float32Array;          // metres; NaN = hole; the block's mean where factor > 1
  least: Float32Array | null;    // of each block; null where factor is 1
  greatest: Float32Array | null;
}

const kHeader = 32;

// Throws Error with what is wrong.
export function readHeights(bytes: ArrayBuffer): HeightReply {
  if (bytes.byteLength < kHeader) throw new Error(`heights: ${bytes.byteLength} bytes are no header of ${kHeader}`);
  const view = new DataView(bytes);
  const magic = String.fromCharCode(view.getUint8(0), view.getUint8(1), view.getUint8(2), view.getUint8(3));
  const [version = 0, width = 0, height = 0, factor = 0, planes = 0, map_width = 0, map_height = 0] = [4, 8, 12, 16, 20, 24, 28].map((at) => view.getUint32(at, true));
  if (magic !== "FVDH" || version !== 1) throw new Error(`heights: "${magic}" version ${version} is not known`);
  const points = width * height;
  if ((planes !== 1 && planes !== 3) || factor < 1 || bytes.byteLength !== kHeader + 4 * points * planes) {
    throw new Error(`heights: ${bytes.byteLength} bytes for ${width} x ${height} x ${planes}`);
  }
  // Every machine that a browser runs on today is little-endian, as the body is.
  const plane = (i: number): Float32Array => new Float32Array(bytes, kHeader + 4 * points * i, points);
  return { width, height, factor, map_width, map_height, values: plane(0), least: planes === 3 ? plane(1) : null, greatest: planes === 3 ? plane(2) : null };
}

export async function fetchHeights(job_id: string, query: Record<string, string | number>, signal?: AbortSignal): Promise<HeightReply> {
  const search = new URLSearchParams(Object.entries(query).map(([key, value]) => [key, String(value)]));
  const response = await fetch(`/api/v1/jobs/${encodeURIComponent(job_id)}/height?${search}`, signal ? { signal } : {});
  if (!response.ok) throw new Error(`HTTP ${response.status}: ${(await response.text()).slice(0, 200)}`);
  return readHeights(await response.arrayBuffer());
}

const kTile = 1024;

// The whole map as it was measured, not reduced, in pieces.
export async function fetchWholeMap(job_id: string, signal?: AbortSignal): Promise<HeightReply> {
  const piece = (x: number, y: number, w: number, h: number): Promise<HeightReply> => fetchHeights(job_id, { x, y, w, h, max: kTile, kind: "height" }, signal);
  const look = await fetchHeights(job_id, { max: 16, kind: "height" }, signal);
  const { map_width, map_height } = look;
  const values = new Float32Array(map_width * map_height);
  for (let y = 0; y < map_height; y += kTile) {
    for (let x = 0; x < map_width; x += kTile) {
      const part = await piece(x, y, Math.min(kTile, map_width - x), Math.min(kTile, map_height - y));
      if (part.factor !== 1) throw new Error(`heights: reduced by ${part.factor} although ${kTile} samples were allowed`);
      for (let row = 0; row < part.height; ++row) values.set(part.values.subarray(row * part.width, (row + 1) * part.width), (y + row) * map_width + x);
    }
  }
  return { width: map_width, height: map_height, factor: 1, map_width, map_height, values, least: null, greatest: null };
}
