#!/usr/bin/env python3
"""The live picture of a camera of 2448 x 2048: pictures a second at the slowest of five viewers, their width, and what
they cost the daemon: its processor time of a scan beside five viewers, beside one, and alone.

live.py BUILD [ROUNDS]
The last line is one JSON object.
"""

import json
import os
import pathlib
import statistics
import sys
import tempfile
import time

from page_rig import PageRig
from rig import wait_for
from viewers import Viewers

WORLD = {"surface": "rough", "width_px": 2448, "height_px": 2048, "base_um": 0}
SECONDS = 10
PER_S = 10  # slices; as many pictures as there may be at most
# In one motion: frames come as fast as the plan wants them, whatever a step would take.
PART = {
    "format": 2,
    "description": "Ten slices a second of the whole sensor",
    "acquire": {"scan": {"mode": "continuous", "start_um": -100, "step_um": 2, "slices": SECONDS * PER_S,
                         "speed_um_per_s": 2 * PER_S, "allowed_lost_slices": SECONDS * PER_S - 10},
                "camera": {"pixel_format": "Mono8", "exposure_us": 2000}},
    "reconstruct": {"focus": {"window_px": 9, "distance_px": 1},
                    "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0}},
}


def processor_s(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        words = file.read().rsplit(") ", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Scans:
    def __init__(self, rig):
        self.rig, self.client, self.seq = rig, rig.start(), 0

    def scan(self):
        """Processor time of the daemon over the scan, per second of it, and slices a second."""
        ask = self.client.ask
        self.seq += 1
        wait_for(lambda: ask("system.state")["ready"], what="ready")
        ask("job.start", seq=self.seq, part_id="part", recipe="part")
        wait_for(lambda: ask("job.status", seq=self.seq)["slices_done"] > 0, what="the first slice")
        begun, used_s = time.monotonic(), processor_s(self.rig.daemon.pid)
        # One that fails never says that the part is free.
        wait_for(lambda: any(ask("job.wait", seq=self.seq, until="acquired")[key] for key in ("acquired", "done")),
                 what="the scan's end")
        passed_s = time.monotonic() - begun
        used = (processor_s(self.rig.daemon.pid) - used_s) / passed_s
        slices = ask("job.status", seq=self.seq)["slices_done"]
        wait_for(lambda: ask("job.wait", seq=self.seq)["done"], what="the job's end")
        ask("result.ack", seq=self.seq)
        return used, slices / passed_s

    def scan_beside(self, viewers):
        with Viewers(self.rig.http_port, viewers) as there:
            used, slices_per_s = self.scan()
        return used, slices_per_s, there.told


def main():
    build = sys.argv[1]
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    cost_5, cost_1, fps, source, widest = [], [], [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        world = pathlib.Path(folder) / "world.json"
        world.write_text(json.dumps(WORLD))
        with PageRig(build, {"part": PART}, simulation=("--world", world)) as rig:
            scans = Scans(rig)
            scans.scan()  # memory is taken, the stage is homed
            for _ in range(rounds):
                alone, _ = scans.scan()
                one, _, _ = scans.scan_beside(1)
                five, slices_per_s, told = scans.scan_beside(5)
                cost_1.append(one - alone)
                cost_5.append(five - alone)
                fps.append(told["pictures_per_s"])
                source.append(slices_per_s)
                widest = max(widest, told["widest_px"])
                print(f"live: {alone:.3f} of a core alone, {one:.3f} with one viewer, {five:.3f} with five; "
                      f"{slices_per_s:.1f} slices/s; {told}", flush=True)
    of_5, of_1 = (round(100 * statistics.median(cost), 1) for cost in (cost_5, cost_1))
    print(json.dumps({"preview_fps": round(statistics.median(fps), 1),
                      "preview_source_fps": round(statistics.median(source), 1), "preview_width_px": widest,
                      "preview_core_percent": of_5, "preview_core_percent_of_1": of_1}))


main()
