#!/usr/bin/env python3
"""Many jobs one after the other, each acknowledged: memory, file descriptors, and the state folder under retention.

soak.py BUILD [JOBS] [FROM]
FROM: the job from which on slopes are told; memory and caches fill before. The last line is one JSON object.
"""

import json
import os
import sys
import time

from rig import Client, Rig, recipe, resident_kib, wait_for

BLOCK = 50  # jobs between two lines of progress
KEEP_GIB = 1  # the least that can be configured: results of 2,000 jobs take four times as much
RETENTION_S = 75  # retention looks once a minute, and removes while the next results come
DATABASE_GIB = 0.02  # not counted by retention
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


def slope(points):
    """By least squares."""
    mean_x = sum(x for x, _ in points) / len(points)
    mean_y = sum(y for _, y in points) / len(points)
    over = sum((x - mean_x) * (y - mean_y) for x, y in points)
    return over / sum((x - mean_x) ** 2 for x, _ in points)


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


def main():
    build = sys.argv[1]
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 2000
    first = int(sys.argv[3]) if len(sys.argv) > 3 else jobs // 4
    memory, files, sizes, times_s = [], [], [], []
    with Rig(build, {"part": PART}) as rig:
        rig.settings["store.keep_gib"] = KEEP_GIB
        rig.start().close()
        pid = rig.daemon.pid
        for seq in range(1, jobs + 1):
            measure(rig, seq)
            memory.append((seq, resident_kib(pid)))
            files.append(descriptors(pid))
            if seq % BLOCK == 0 or seq == jobs:
                sizes.append(gib(rig.state))
                times_s.append(time.monotonic())
                print(f"soak: {seq} jobs, {memory[-1][1]} KiB, {files[-1]} descriptors, {sizes[-1]:.3f} GiB", flush=True)
        kept = len(list((rig.state / "results").iterdir()))
        rig.stop()
    third = (jobs - first) // 3
    if third < 1:
        sys.exit(f"{jobs} jobs are too few for a slope from job {first} on")
    # Descriptors come and go behind a result: a leak raises the least number. Of memory it is told beside the slope, which
    # is judged: what the allocator keeps for a while, up to 5 MiB, is in the slope, too.
    gained = min(files[-third:]) - min(files[first:first + third])
    resident = [kib for _, kib in memory]
    grown_kib = min(resident[-third:]) - min(resident[first:first + third])
    # What comes between two looks of retention.
    paces = [(sizes[i] - sizes[i - 1]) / (times_s[i] - times_s[i - 1]) for i in range(1, len(sizes))]
    most_gib = KEEP_GIB + max(paces, default=0.0) * RETENTION_S + DATABASE_GIB
    was_needed = kept < jobs
    print(f"soak: {kept} results of {jobs} are kept, {max(sizes):.3f} GiB at most"
          f", {most_gib:.3f} allowed" + ("" if was_needed else ": retention had nothing to do"))
    print(json.dumps({"soak_jobs": jobs, "rss_slope_kib_per_job": round(slope(memory[first:]), 3),
                      "rss_least_kib_per_job": round(grown_kib / (2 * third), 3),
                      "fd_slope_per_job": round(gained / (2 * third), 4), "state_gib_most": round(max(sizes), 3),
                      "state_gib_bounded": was_needed and max(sizes) <= most_gib}))


main()
