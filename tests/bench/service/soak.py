#!/usr/bin/env python3
"""Many jobs one after the other, each acknowledged: memory, file descriptors, and the state folder under retention.

soak.py BUILD [JOBS] [FROM]
FROM: the job from which on slopes are told; memory and caches fill before. The last line is one JSON object.

What is judged is rss_slope_kib_per_job: memory every 10 jobs, once the daemon has nothing to do, which a leak raises.
The other slopes are those after each job, while files of its result are still being made: a picture of them takes 6 MiB
meanwhile, and whether it is just being drawn has more weight than years of a small leak. busy: all memory; anon: without
programs and files that are mapped; heap_in_use: taken and not freed; heap_held: that, and what the allocator keeps.
"""

import http.client
import json
import os
import re
import sys
import time

from rig import ANSWER_TIMEOUT_S, Client, Rig, memory_kib, recipe, wait_for

BLOCK = 50  # jobs between two lines of progress
IDLE = 10  # jobs between two looks at the daemon at rest
KEEP_GIB = 1  # the least that can be configured: results of 2,000 jobs take four times as much
RETENTION_S = 75  # retention looks once a minute, and removes while the next results come
DATABASE_GIB = 0.02  # not counted by retention
SLOPES = (("busy_slope_kib_per_job", "VmRSS"), ("anon_slope_kib_per_job", "RssAnon"),
          ("heap_in_use_slope_kib_per_job", "heap_in_use"), ("heap_held_slope_kib_per_job", "heap_held"))
LINE = ("soak: {seq} jobs, {VmRSS} KiB ({RssAnon} anon, {RssFile} of files; of the heap {heap_in_use:.0f} in use, "
        "{heap_held:.0f} held; idle {idle}), {descriptors} descriptors, {gib:.3f} GiB")
PART = recipe(slices=5)
# Retention has begun, and its memory is there, before slopes are told.
PART["acquire"]["camera"].update(width_px=384, height_px=288)
PART["keep"] = {"slices": True}


def descriptors(pid):
    return len(os.listdir(f"/proc/{pid}/fd"))


def gib(folder):
    """What is removed meanwhile does not count."""
    total = 0
    for path, _, names in os.walk(folder):
        for name in names:
            try:
                total += os.stat(os.path.join(path, name)).st_size
            except FileNotFoundError:
                pass
    return total / 2**30


def slope(samples, key):
    """A job's share in it, by least squares."""
    mean_x = sum(sample["seq"] for sample in samples) / len(samples)
    mean_y = sum(sample[key] for sample in samples) / len(samples)
    over = sum((sample["seq"] - mean_x) * (sample[key] - mean_y) for sample in samples)
    return over / sum((sample["seq"] - mean_x) ** 2 for sample in samples)


def metrics_port(rig):
    """The log alone tells it."""
    found = wait_for(lambda: re.search(r"metrics on 127\.0\.0\.1:(\d+)", (rig.folder / "fvd.log").read_text()),
                     what=f"/metrics, see {rig.folder}")
    return int(found[1])


def heap_kib(port):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=ANSWER_TIMEOUT_S)
    connection.request("GET", "/metrics")
    page = connection.getresponse().read().decode()
    connection.close()
    return {name: float(size) / 1024 for name, size in re.findall(r"^fvd_(heap_\w+)_bytes (\S+)$", page, re.M)}


def look(pid, port, seq):
    sample = {"seq": seq, **memory_kib(pid), "descriptors": descriptors(pid)}
    return sample | heap_kib(port)  # last, for it opens a connection


def await_files(rig, seq):
    """Until all files of the result are there, and its row says so: the last that is done for a job."""
    client = Client(rig.socket)
    wait_for(lambda: "follow_ms" in client.ask("result.get", seq=seq, format="complete")["result"]["times"],
             what=f"the files of job {seq}, see {rig.folder}")
    client.close()


def measure(rig, seq):
    """As a PLC that connects anew for each part."""
    client = Client(rig.port)
    wait_for(lambda: client.ask("system.state")["ready"], what=f"ready, see {rig.folder}")
    client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
    ended = client.ask("job.wait", seq=seq)
    if ended["state"] != "completed":
        sys.exit(f"job {seq} is {ended['state']}, {ended['error_message']}: see {rig.folder}")
    client.ask("result.get", seq=seq, format="full")
    client.ask("result.ack", seq=seq)
    client.close()


def risen(samples, idle, first):
    late = [sample for sample in idle if sample["seq"] > first]
    if len(late) < 2:
        sys.exit(f"the daemon was looked at {len(late)} times at rest from job {first} on: too few for a slope")
    slopes = {"rss_slope_kib_per_job": slope(late, "VmRSS")}
    slopes |= {name: slope(samples[first:], key) for name, key in SLOPES}
    return {name: round(kib, 3) for name, kib in slopes.items()}


def main():
    build = sys.argv[1]
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 2000
    first = int(sys.argv[3]) if len(sys.argv) > 3 else jobs // 4
    samples, idle, sizes, times_s = [], [], [], []
    with Rig(build, {"part": PART}) as rig:
        rig.settings |= {"store.keep_gib": KEEP_GIB, "metrics.port": 0}
        rig.start().close()
        pid, port = rig.daemon.pid, metrics_port(rig)
        for seq in range(1, jobs + 1):
            measure(rig, seq)
            samples.append(look(pid, port, seq))
            if seq % max(1, min(IDLE, first)) == 0 or seq == jobs:
                await_files(rig, seq)
                idle.append(look(pid, port, seq))
            if seq % BLOCK == 0 or seq == jobs:
                sizes.append(gib(rig.state))
                times_s.append(time.monotonic())
                print(LINE.format(**samples[-1], idle=idle[-1]["VmRSS"], gib=sizes[-1]), flush=True)
        kept = len(list((rig.state / "results").iterdir()))
        rig.stop()
    third = (jobs - first) // 3
    if third < 1:
        sys.exit(f"{jobs} jobs are too few for a slope from job {first} on")

    def gained(key):
        """Of the least number, from the first third to the last one."""
        of = [sample[key] for sample in samples]
        return (min(of[-third:]) - min(of[first:first + third])) / (2 * third)

    # What comes between two looks of retention.
    paces = [(sizes[i] - sizes[i - 1]) / (times_s[i] - times_s[i - 1]) for i in range(1, len(sizes))]
    most_gib = KEEP_GIB + max(paces, default=0.0) * RETENTION_S + DATABASE_GIB
    was_needed = kept < jobs
    print(f"soak: {kept} results of {jobs} are kept, {max(sizes):.3f} GiB at most"
          f", {most_gib:.3f} allowed" + ("" if was_needed else ": retention had nothing to do"))
    # Descriptors come and go behind a result: a leak raises the least number.
    print(json.dumps({"soak_jobs": jobs, **risen(samples, idle, first),
                      "rss_least_kib_per_job": round(gained("VmRSS"), 3),
                      "fd_slope_per_job": round(gained("descriptors"), 4), "state_gib_most": round(max(sizes), 3),
                      "state_gib_bounded": was_needed and max(sizes) <= most_gib}))


main()
