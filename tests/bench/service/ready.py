#!/usr/bin/env python3
"""How soon the daemon is ready: from its start, and after a SIGKILL from the moment at which the camera gives up the
control of the one that is gone.

ready.py BUILD [STARTS]
Prints a line of details and, last, one JSON object.
"""

import json
import os
import sys
import threading
import time

from rig import Camera, Client, Rig, percentile, wait_for


def forget(file):
    """Drops the program from the page cache, as far as no other process has it mapped."""
    with open(file, "rb") as program:
        os.posix_fadvise(program.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


class Release(threading.Thread):
    """Waits until nobody controls the camera; `at` is the last moment at which somebody did."""

    def __init__(self, address):
        super().__init__(daemon=True)
        self.camera = Camera(address)
        self.at = None
        self.start()

    def run(self):
        before = time.monotonic()
        while self.camera.controlled():
            before = time.monotonic()
            time.sleep(0.002)
        self.at = before


def ready_in_s(rig):
    """From the process's start; and the moment of it."""
    client = rig.start()
    client.close()
    return rig.ready_after_s, time.monotonic()


def main():
    build = sys.argv[1]
    starts = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    cold_ms, beyond_ms = [], []
    with Rig(build) as rig:
        for _ in range(starts):
            forget(rig.build / "daemon/fvd")
            cold_ms.append(1000 * ready_in_s(rig)[0])
            rig.stop()
        ready_in_s(rig)
        for i in range(starts):
            client = Client(rig.port)
            client.ask("job.start", seq=i + 1, part_id="part", recipe="part")
            wait_for(lambda: client.ask("job.status", seq=i + 1)["slices_done"] > 1, what="slices")
            client.close()
            rig.kill()
            release = Release(rig.plant["camera_address"])
            ready = ready_in_s(rig)[1]
            release.join(20)
            if release.at is None:
                sys.exit("the camera was never given up: its release cannot be told from the new control")
            beyond_ms.append(1000 * (ready - release.at))
        rig.stop()
    print(f"ready: cold median {percentile(cold_ms, 0.5):.0f} ms; after a kill median "
          f"{percentile(beyond_ms, 0.5):.0f} ms beyond the camera's release; {starts} each")
    print(json.dumps({"ready_cold_ms": round(max(cold_ms)), "ready_after_kill_ms": round(max(beyond_ms)),
                      "ready_starts": starts}))


main()
