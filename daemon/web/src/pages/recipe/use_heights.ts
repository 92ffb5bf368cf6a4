// The map of the result that is looked at, coarse enough to be drawn on.
import { useEffect, useState } from "preact/hooks";
import { messageOf } from "../../parts/message_of.ts";
import { type Tile, fetchTile } from "../../surface/height_tile.ts";
import type { Newest } from "./newest_job.ts";

export function useHeights(newest: Newest): { heights: Tile | null; problem: string } {
  const [heights, setHeights] = useState<Tile | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    setHeights(null);
    setProblem("");
    if (!newest.job_id || !newest.result) return;
    const ending = new AbortController();
    fetchTile(newest.job_id, "height", null, 512, ending.signal).then(setHeights, (error) => {
      if (!ending.signal.aborted) setProblem(messageOf(error));
    });
    return () => ending.abort();
  }, [newest.job_id, newest.result !== null]);
  return { heights, problem };
}
