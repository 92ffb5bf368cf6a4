// The newest completed jobs, to choose from. Where the daemon has no list of jobs, those that this tab saw.
import { useEffect, useState } from "preact/hooks";
import { createStore, useStore } from "../../../lib/store.ts";
import { results, topics } from "../../../live/live.ts";
import { type ListedJob, isNotOffered, listJobs } from "../to_come.ts";

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
  jobs: KnownJob[];
  isListed: boolean;  // false: only those that were seen
}

export function useKnownJobs(): KnownJobs {
  const own = useStore(seen);
  const { count } = useStore(results);
  const [listed, setListed] = useState<ListedJob[] | null>(null);
  useEffect(() => {
    let gone = false;
    listJobs({ state: "completed", most: kMost }).then(
      (jobs) => gone || setListed(jobs),
      (error: unknown) => {
        // Without a list ids can still be typed; why there is none matters only where the daemon should have one.
        if (!gone && !isNotOffered(error)) setListed(null);
      });
    return () => void (gone = true);
  }, [count]);
  return listed === null ? { jobs: own, isListed: false } : { jobs: listed, isListed: true };
}
