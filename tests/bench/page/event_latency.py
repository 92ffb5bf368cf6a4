#!/usr/bin/env python3
"""From the call that changes something to the event that tells it: while nothing runs, and beside a scan.

event_latency.py BUILD [ROUNDS]
The last line is one JSON object.
"""

import json
import sys

from event_stream import Follower
from page_rig import PageRig
from rig import percentile, recipe, wait_for

LONG = recipe(start_um=-100, step_um=1, slices=400)


def timed(client, follower, owners):
    """Each takes control under another name, which changes the document of control."""
    times_ms = []
    for owner in owners:
        before = follower.count()
        sent = client.send("control.acquire", owner=owner, lease_s=60)
        client.receive()
        event = follower.find(lambda e, owner=owner: e.name == "control" and e.data["owner"] == owner, before)
        times_ms.append(1000 * (event.at_s - sent))
    return times_ms


def main():
    build = sys.argv[1]
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    with PageRig(build, {"long": LONG}) as rig:
        client = rig.start()
        follower = Follower(rig.http_port)
        follower.find(lambda e: e.name == "snapshot")
        at_rest = timed(client, follower, [f"rest-{i}" for i in range(rounds // 2)])
        before = follower.count()
        client.ask("job.start", seq=1, part_id="part", recipe="long")
        follower.find(lambda e: e.name == "job" and e.data["slices_done"] > 0, before)
        beside = timed(client, follower, [f"scan-{i}" for i in range(rounds // 2)])
        still_scans = not client.ask("job.status", seq=1)["acquired"]
        client.ask("job.abort", seq=1)
        wait_for(lambda: client.ask("system.state")["ready"], what="ready")
        follower.close()
    if not still_scans:
        sys.exit("the scan ended before the last of the rounds: give it more slices, or fewer rounds")
    for name, values in (("at rest", at_rest), ("beside a scan", beside)):
        print(f"event, {name}: median {percentile(values, 0.5):.1f}, p99 {percentile(values, 0.99):.1f}, "
              f"longest {max(values):.1f} ms of {len(values)}")
    both = at_rest + beside
    print(json.dumps({"event_latency_ms": round(percentile(both, 0.99), 1), "events_timed": len(both)}))


main()
