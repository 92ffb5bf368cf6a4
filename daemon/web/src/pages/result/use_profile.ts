// The profile along a line: the daemon's, or where lengths are not known one that is taken here from the points at full resolution.
import { useEffect, useState } from "preact/hooks";
import { call } from "../../rpc/rpc.ts";
import { kBlock, valueIn } from "../../surface/full_map.ts";
import type { Tile } from "../../surface/height_tile.ts";
import { type LineProblem, type Profile, type ProfileLine, type Values, blocksOf, profileOf, samplesOf } from "../../surface/profile_line.ts";
import type { ResultMap } from "./use_map.ts";

export interface TakenProfile {
  profile: Profile | null;
  line: ProfileLine | null;  // along which it was taken
  by: "daemon" | "page";
  problem: LineProblem | null;
  error: unknown;
}

const kWait_ms = 80;  // while an end is dragged

async function takeHere(map: ResultMap, line: ProfileLine): Promise<Profile | LineProblem> {
  const samples = samplesOf(map.size, line);
  if (typeof samples === "string") return samples;
  const places = blocksOf(map.size, samples, kBlock);
  const load = async (kind: "height" | "sigma"): Promise<Values> => {
    const blocks = new Map<string, Tile>();
    await Promise.all(places.map(async ({ column, row }) => blocks.set(`${column} ${row}`, await map.full.block(kind, column, row))));
    return (column, row) => {
      const block = blocks.get(`${Math.floor(column / kBlock) * kBlock} ${Math.floor(row / kBlock) * kBlock}`);
      if (!block || !map.full.has({ column, row })) return NaN;
      return valueIn(block, column, row) * 1e6;
    };
  };
  const heights = await load("height");
  const sigmas = await load("sigma").catch((): Values => () => NaN);  // without standard errors there is still a profile
  return profileOf(map.size, samples, heights, sigmas);
}

async function askDaemon(map: ResultMap, line: ProfileLine, signal: AbortSignal): Promise<Profile> {
  const params = { job_id: map.full.job, from_um: line.from, to_um: line.to, width_um: line.width_um };
  const { distance_um, height_um, sigma_um } = await call("result.profile", params, { signal });
  return { distance_um: distance_um as number[], height_um: height_um as (number | null)[], sigma_um: sigma_um as (number | null)[] };
}

export function useProfile(map: ResultMap, line: ProfileLine): TakenProfile {
  const [taken, setTaken] = useState<TakenProfile>({ profile: null, line: null, by: "page", problem: null, error: null });
  const key = JSON.stringify(line);
  useEffect(() => {
    const abort = new AbortController();
    const take = async (): Promise<TakenProfile> => {
      const none = { profile: null, line, by: "page" as const, problem: null, error: null };
      try {
        const samples = samplesOf(map.size, line);
        if (typeof samples === "string") return { ...none, problem: samples };
        if (map.has_pitch) return { ...none, profile: await askDaemon(map, line, abort.signal), by: "daemon" };
        const made = await takeHere(map, line);
        return typeof made === "string" ? { ...none, problem: made } : { ...none, profile: made };
      } catch (error) {
        return { ...none, error };
      }
    };
    const timer = setTimeout(() => void take().then((next) => {
      if (!abort.signal.aborted) setTaken(next);
    }), kWait_ms);
    return () => {
      clearTimeout(timer);
      abort.abort();
    };
  }, [map, key]);
  return taken;
}
