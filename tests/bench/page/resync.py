#!/usr/bin/env python3
"""Readers whose last id nobody knows any more: of before a kill, of the future, no id at all. Each is told everything
anew, and what it is told then is what the calls tell.

resync.py BUILD [RESTARTS]
The last line is one JSON object.
"""

import json
import sys
import time

from event_stream import EventStream, Follower
from page_rig import PageRig

# What passes by itself, without an event.
PASSING = {"state": {"hb"}, "job": {"age_s"}, "control": {"remaining_s"}}
SETTLED_S = 5  # events of what was called before are on their way
FORGED = ("{epoch}-{future}", "{epoch}-0x1", "{epoch}-", "-1", "{older}-1", "{newer}-1", "0", "*", "a" * 2000, "1-2-3")


def by_calls(client, job_id):
    documents = {"state": client.ask("system.state", format="full"), "control": client.ask("control.state")}
    if job_id:
        documents["job"] = client.ask("job.status", job_id=job_id, format="full")
    return documents


def differences(told, called):
    """What a call tells that the stream has otherwise; a call leaves out what is too long for a line."""
    found = []
    for topic, document in called.items():
        for key, value in document.items():
            if key in PASSING[topic] or key == "left_out":
                continue
            if not told.get(topic) or told[topic].get(key) != value:
                found.append(f"{topic}.{key}: {(told.get(topic) or {}).get(key)} for {value}")
    return found


def documents_of(events):
    """What a page knows after these: the last snapshot and what came behind it."""
    known = {}
    for event in events:
        if event.name == "snapshot":
            known = dict(event.data)
        elif event.name in ("state", "job", "control", "health", "alarms"):
            known[event.name] = event.data
    return known


class Watch:
    """Compares until nothing differs, or for as long as events may take."""

    def __init__(self):
        self.differs = self.compared = 0

    def compare(self, what, client, follower):
        deadline = time.monotonic() + SETTLED_S
        while True:
            with follower.changed:
                told = documents_of(follower.seen)
            found = differences(told, by_calls(client, (told.get("job") or {}).get("job_id", "")))
            if not found or time.monotonic() > deadline:
                break
            with follower.changed:
                follower.changed.wait(0.05)
        self.compared += 1
        self.differs += bool(found)
        for line in found:
            print(f"state_differs_after_resync: {what}: {line}", flush=True)


def is_told_anew(port, last_event_id):
    """Whether a stream with this id begins with resync and snapshot."""
    stream = EventStream(port, last_event_id)
    try:
        names = [getattr(stream.next(), "name", None) for _ in range(2)] if stream.status == 200 else [stream.status]
    finally:
        stream.close()
    if names != ["resync", "snapshot"]:
        print(f"id {last_event_id[:40]!r} is answered with {names}", flush=True)
    return names == ["resync", "snapshot"]


def main():
    build = sys.argv[1]
    restarts = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    watch, anew, asked = Watch(), 0, 0
    with PageRig(build) as rig:
        client = rig.start()
        last_id = None
        for seq in range(1, restarts + 1):
            if last_id is not None:
                asked += 1
                anew += is_told_anew(rig.http_port, last_id)
            follower = Follower(rig.http_port, last_id)
            watch.compare(f"start {seq}", client, follower)
            client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
            if seq % 2 == 0:  # else killed while it measures
                client.ask("job.wait", seq=seq)
                watch.compare(f"job {seq}", client, follower)
            follower.find(lambda e, seq=seq: e.name == "job" and e.data["seq"] == seq)
            last_id = next(event.id for event in reversed(follower.seen) if event.id)
            client.close()
            rig.kill()
            follower.close()
            client = rig.start()
        epoch = client.ask("system.state")["epoch"]
        for text in FORGED:
            asked += 1
            anew += is_told_anew(rig.http_port, text.format(epoch=epoch, older=epoch - 1, newer=epoch + 1, future=10**9))
        follower = Follower(rig.http_port, "nobody-1")
        watch.compare("a forged id", client, follower)
        follower.close()
    print(json.dumps({"state_differs_after_resync": watch.differs, "states_compared": watch.compared,
                      "resyncs_asked": asked, "resyncs_missing": asked - anew}))


main()
