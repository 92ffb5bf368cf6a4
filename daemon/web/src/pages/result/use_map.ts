// The map of a result: its size and an overview of what it shows.
import { useEffect, useMemo, useState } from "preact/hooks";
import { type Kind, type Tile, fetchTile } from "../../surface/height_tile.ts";
import { FullMap } from "../../surface/full_map.ts";
import type { MapSize } from "../../surface/map_view.ts";
import { type ResultJson, mapOwner } from "../../result/result_json.ts";

export interface ResultMap {
  full: FullMap;
  size: MapSize;
  has_pitch: boolean;  // false: lengths along the surface are in points
  unit: string;  // of lengths along the surface
}

export const kOverview = 512;

export interface Overview {
  tile: Tile | null;
  error: unknown;
}

export function useOverview(job: string, kind: Kind): Overview {
  const [overview, setOverview] = useState<Overview>({ tile: null, error: null });
  useEffect(() => {
    const abort = new AbortController();
    fetchTile(job, kind, null, kOverview, abort.signal).then(
      (tile) => setOverview({ tile, error: null }),
      (error: unknown) => {
        if (!abort.signal.aborted) setOverview({ tile: null, error });
      });
    return () => abort.abort();
  }, [job, kind]);
  return overview.tile?.kind === kind || overview.error ? overview : { tile: null, error: null };
}

// Null until the first tile told the map's size.
export function useMap(result: ResultJson, tile: Tile | null): ResultMap | null {
  const job = mapOwner(result);
  const [width, height] = [tile?.map_width, tile?.map_height];
  return useMemo(() => {
    if (!width || !height) return null;
    const { pixel_pitch_x_um: x, pixel_pitch_y_um: y } = result.focus ?? {};
    const has_pitch = Boolean(x && y);
    return {
      full: new FullMap(job, width, height),
      size: { width, height, pitch_x: x || 1, pitch_y: y || 1 },
      has_pitch,
      unit: has_pitch ? "µm" : "px",
    };
  }, [job, width, height]);
}
