// The newest completed jobs, to choose from. Where the list does not come, those that this tab saw.
import { useEffect, useState } from "preact/hooks";
import { createStore, useStore } from "../../../lib/store.ts";
import { results, topics } from "../../../live/live.ts";
import type { JobRow } from "../../../rpc/listed.ts";
import { call } from "../../../rpc/rpc.ts";

export interface KnownJob {
  job_id: string;
  part_id: string;
  recipe: string;
  ended_utc: string;
}

const kMost = 100;
const seen = createStore<KnownJob[]>([]);

topics.watch(() => {
  const { job } = topics.get();
  if (!job?.done || job.state !== "completed") return;
  const { job_id = "", part_id, recipe = "", ended_utc = "" } = job;
  seen.update((jobs) => (jobs.some((each) => each.job_id === job_id) ? jobs : [{ job_id, part_id, recipe, ended_utc }, ...jobs].slice(0, kMost)));
});

export interface KnownJobs {
  jobs: readonly KnownJob[];
  isListed: boolean;  // false: only those that were seen
}

export function useKnownJobs(): KnownJobs {
  const own = useStore(seen);
  const { count } = useStore(results);
  const [listed, setListed] = useState<readonly JobRow[] | null>(null);
  useEffect(() => {
    let gone = false;
    // Without a list ids can still be typed.
    call("job.list", { state: "completed", most: kMost }).then(({ jobs }) => gone || setListed(jobs), () => gone || setListed(null));
    return () => void (gone = true);
  }, [count]);
  return listed === null ? { jobs: own, isListed: false } : { jobs: listed, isListed: true };
}
