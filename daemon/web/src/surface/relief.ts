// Relief shading from above: what is drawn where a browser has no WebGL2.
import type { Mesh } from "./height_mesh.ts";
import { kHoleColour, rgba } from "./colours.ts";

// The mesh's colours are shaded already; vertices that belong to no triangle are holes.
export function reliefPixels(mesh: Mesh): Uint8ClampedArray<ArrayBuffer> {
  const pixels = new Uint32Array(mesh.columns * mesh.rows).fill(rgba(kHoleColour));
  const colours = new Uint32Array(mesh.colours.buffer, mesh.colours.byteOffset, pixels.length);
  for (const i of mesh.triangles) pixels[i] = colours[i] as number;
  return new Uint8ClampedArray(pixels.buffer);
}
