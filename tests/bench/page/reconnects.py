#!/usr/bin/env python3
"""A stream that is cut 50 times and goes on by its last id, beside one that is never cut: what the one has, the other has.

reconnects.py BUILD [CUTS]
The last line is one JSON object.
"""

import json
import random
import sys
import threading

from event_stream import EventStream, Follower
from page_rig import PageRig
from rig import Client


class Load(threading.Thread):
    """Changes control and runs jobs, so that there are events of all kinds."""

    def __init__(self, port):
        super().__init__()
        self.client, self.is_over, self.failure = Client(port), False, None
        self.start()

    def run(self):
        try:
            seq = 0
            while not self.is_over:
                seq += 1
                for i in range(10):
                    self.client.ask("control.acquire", owner=f"load-{seq}-{i}", lease_s=60)
                self.client.ask("job.start", seq=seq, part_id=f"part-{seq}", recipe="part")
                self.client.ask("job.wait", seq=seq)
                self.client.ask("result.ack", seq=seq)
            self.client.ask("control.acquire", owner="the-end", lease_s=60)
        except Exception as error:  # told by end()
            self.failure = error

    def end(self):
        self.is_over = True
        self.join()
        if self.failure:
            sys.exit(f"the load failed: {self.failure!r}")


class CutReader:
    """Reads a few events, goes away until others were told, comes back with the last id that it has."""

    def __init__(self, port, reference):
        self.port, self.reference = port, reference
        self.ids, self.anew = [], 0
        self.stream = EventStream(port)

    def take(self, events):
        """False at an event that is no continuation."""
        for _ in range(events):
            event = self.stream.next()
            if event is None:
                sys.exit("the stream ended by itself")
            if event.name in ("snapshot", "resync") and self.ids:
                self.anew += 1
                return False
            if event.name != "ping" and event.id:
                self.ids.append(event.id)
        return True

    def cut(self, events_away):
        self.stream.close()
        there = self.reference.count() + events_away
        self.reference.find(lambda _: True, max(0, there - 1))
        self.stream = EventStream(self.port, self.ids[-1])


def is_end(event):
    return event.name == "control" and event.data["owner"] == "the-end"


def compare(told, got):
    """How many of the events between the first and the last that the cut reader got lack, and how many came twice or in
    another order. What was told after its last, it had no time to read."""
    for event in (got[0], got[-1]):
        if event not in told:
            sys.exit(f"the event {event} was told to one reader alone")
    known = set(got)
    missed = [event for event in told[told.index(got[0]):told.index(got[-1]) + 1] if event not in known]
    for event in missed[:10]:
        print(f"events_missed: {event}", flush=True)
    return len(missed), sum(1 for a, b in zip(got, got[1:]) if int(b.split("-")[-1]) <= int(a.split("-")[-1]))


def main():
    build = sys.argv[1]
    cuts = int(sys.argv[2]) if len(sys.argv) > 2 else 50
    pick = random.Random(1)
    with PageRig(build) as rig:
        rig.start().close()
        reference = Follower(rig.http_port)
        reference.find(lambda e: e.name == "snapshot")
        load = Load(rig.port)
        reader = CutReader(rig.http_port, reference)
        reader.take(3)
        resumed = 0
        for _ in range(cuts):
            reader.cut(pick.choice((0, 1, 2, 5, 20)))
            resumed += reader.take(pick.randint(1, 5))
        load.end()
        last = reference.find(is_end)
        while reader.ids[-1] != last.id:
            reader.take(1)
        reader.stream.close()
        reference.close()
        missed, disordered = compare([event.id for event in reference.seen if event.id], reader.ids)
    print(f"reconnects: {resumed} of {cuts} went on, {len(reader.ids)} events read, {len(reference.seen)} told")
    key = "reconnects_of_50" if cuts == 50 else f"reconnects_of_{cuts}"
    print(json.dumps({key: resumed, "events_missed": missed, "events_disordered": disordered,
                      "events_told": len(reference.seen)}))


main()
