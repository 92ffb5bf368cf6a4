#!/usr/bin/env python3
"""Clients that poll while the machine scans: 100,000 results that nobody acknowledged, a disk that takes 500 ms to sync,
and viewers that never read. The scans last longer than the polls, so that each call is beside one.

poll.py BUILD [SECONDS] [RESULTS] [CALLS_PER_S] [SLICES] [JOBS]
The last line is one JSON object.
"""

import json
import subprocess
import sys
import threading
import time

from many_jobs import copy_jobs
from rig import Client, Rig, late_slices, recipe, wait_for

SYNC_MS = 500


class Acknowledger(threading.Thread):
    """Acknowledges old results, one after the other: each is a commit beside the scan."""

    def __init__(self, port, results):
        super().__init__()
        self.client, self.done, self.is_over = Client(port), 0, False
        self.last = results  # what comes behind it is the job that runs
        self.longest_ms, self.failure = 0.0, None

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, kind, *_):
        self.is_over = True
        self.join()
        if kind is None:
            self.demand_load()

    def run(self):
        try:
            while not self.is_over and self.done + 2 <= self.last:
                sent = time.monotonic()
                self.client.ask("result.ack", seq=self.done + 2)
                self.longest_ms = max(self.longest_ms, 1000 * (time.monotonic() - sent))
                self.done += 1
        except Exception as error:  # told by demand_load()
            self.failure = error

    def demand_load(self):
        """Without commits that wait for a slow disk, times beside them tell nothing."""
        if self.failure:
            sys.exit(f"acknowledgement {self.done + 1} failed: {self.failure!r}")
        if self.done < 1 or self.longest_ms < SYNC_MS:
            sys.exit(f"{self.done} acknowledgements, the longest {self.longest_ms:.0f} ms: the disk was not slow")


def loaded(rig, seq, seconds, rate):
    """What poll_load measured; it fails where one of its clients and viewers is not let in."""
    words = (rig.build / "tests/bench/service/poll_load", rig.port, seq, seconds, rate)
    load = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, text=True, check=False)
    if load.returncode != 0:
        sys.exit(f"poll_load ended with {load.returncode}")
    return json.loads(load.stdout)


def complete(client, rig, seq):
    """Waits for the job's end, longer than job.wait alone does; ends the program unless the job is completed."""
    def end():
        told = client.ask("job.wait", seq=seq)
        return told["done"] and told

    ended = wait_for(end, what=f"the end of job {seq}")
    if ended["state"] != "completed":
        sys.exit(f"a job is {ended['state']}, {ended['error_message']}: see {rig.folder}")


def main():
    build = sys.argv[1]
    standards = (15, 100_000, 2000, 800, 2)
    seconds, results, rate, slices, jobs = (int(sys.argv[i]) if len(sys.argv) > i else standard
                                            for i, standard in enumerate(standards, 2))
    with Rig(build, {"part": recipe(start_um=-100, step_um=0.5, slices=slices)}) as rig:
        rig.settings["rpc.max_connections"] = 64
        client = rig.start()
        client.ask("job.start", seq=1, part_id="part", recipe="part")
        complete(client, rig, 1)
        rig.stop()
        copy_jobs(rig.state / "fvd.sqlite", results, {"acknowledged": "0"})
        rig.environment = [f"LD_PRELOAD={rig.build / 'tests/bench/libbench_slow_sync.so'}", f"FVD_SLOW_SYNC_MS={SYNC_MS}"]
        client = rig.start()
        waiting = client.ask("system.state")["results_waiting"]
        if waiting != results:
            sys.exit(f"{waiting} results wait, not {results}: see {rig.folder}")
        figures, late = [], 0
        with Acknowledger(rig.port, results) as acknowledger:
            for seq in range(results + 1, results + 1 + jobs):
                client.ask("job.start", seq=seq, part_id="part", recipe="part")
                figures.append(loaded(rig, seq, seconds, rate))
                if client.ask("job.status", seq=seq)["acquired"]:
                    sys.exit(f"the scan ended before the {seconds} s of polls: give it more slices than {slices}")
                complete(client, rig, seq)
                result = client.ask("result.get", seq=seq, format="full", fields=["frames", "slices", "times"])
                late += late_slices(result)
                print(f"poll: {figures[-1]}, scan {result['times']['scan_ms']:.0f} ms")
        rig.stop()
    print(f"poll: {acknowledger.done} acknowledgements meanwhile, the longest {acknowledger.longest_ms:.0f} ms")
    print(json.dumps({"poll_p99_ms": round(max(told["p99_ms"] for told in figures), 2), "late_slices": late,
                      "poll_calls": sum(told["calls"] for told in figures), "poll_jobs": jobs,
                      "poll_acks": acknowledger.done, "poll_longest_ack_ms": round(acknowledger.longest_ms)}))


main()
