#!/usr/bin/env python3
"""Jobs without viewers and jobs beside eight, of whom three never read: slices that came late, the time from the part's
release to the result, the daemon's memory.

beside_viewers.py BUILD [BLOCKS] [JOBS]
BLOCKS of JOBS of each kind in turn, so that a busy machine disturbs both. The last line is one JSON object.
"""

import json
import statistics
import sys
import time

from page_rig import PageRig
from rig import late_slices, resident_kib, wait_for
from viewers import Viewers

READERS, NEVER = 5, 3
WARM_UP = 3
PART = {
    "format": 2,
    "description": "The whole of the simulated sensor",
    "acquire": {"scan": {"start_um": -7, "step_um": 5, "slices": 41},
                "camera": {"pixel_format": "Mono8", "exposure_us": 1000}},
    "reconstruct": {"focus": {"window_px": 9, "min_prominence": 0.5},
                    "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0}},
}


class Line:
    """Runs jobs one after the other, as a line does."""

    def __init__(self, client):
        self.client, self.seq = client, 0

    def job(self):
        """Late slices, and the seconds from the release to the result."""
        ask = self.client.ask
        self.seq += 1
        wait_for(lambda: ask("system.state")["ready"], what="ready")
        ask("job.start", seq=self.seq, part_id=f"part-{self.seq}", recipe="part")
        wait_for(lambda: ask("job.wait", seq=self.seq, until="acquired")["acquired"], what="the part's release")
        released = time.monotonic()
        ended = ask("job.wait", seq=self.seq)
        passed_s = time.monotonic() - released
        if ended["state"] != "completed":
            sys.exit(f"a job is {ended['state']}, {ended['error_message']}")
        late = late_slices(ask("result.get", seq=self.seq, format="full"))
        ask("result.ack", seq=self.seq)
        return late, passed_s


def main():
    build = sys.argv[1]
    blocks, jobs = (int(sys.argv[i]) if len(sys.argv) > i else usual for i, usual in ((2, 4), (3, 6)))
    alone, beside, late = [], [], {"alone": 0, "beside": 0}
    with PageRig(build, {"part": PART}) as rig:
        line = Line(rig.start())
        for _ in range(WARM_UP):
            line.job()
        without_kib, with_kib = resident_kib(rig.daemon.pid), 0
        told = []
        for _ in range(blocks):
            for _ in range(jobs):
                slices, passed_s = line.job()
                alone.append(passed_s)
                late["alone"] += slices
            with Viewers(rig.http_port, READERS, NEVER) as viewers:
                for _ in range(jobs):
                    slices, passed_s = line.job()
                    beside.append(passed_s)
                    late["beside"] += slices
                    with_kib = max(with_kib, resident_kib(rig.daemon.pid))
            told.append(viewers.told)
        rig.stop()
    print(f"viewers: {told}")
    print(f"release to result: alone {1000 * statistics.median(alone):.1f}, beside {READERS + NEVER} viewers "
          f"{1000 * statistics.median(beside):.1f} ms; late slices {late}; {without_kib} KiB before, {with_kib} KiB at most")
    if any(block["pictures"] == 0 or block["maps"] == 0 for block in told):
        sys.exit("the viewers saw nothing: nothing was tested")
    print(json.dumps({"late_slices_with_8_viewers": late["beside"], "late_slices_alone": late["alone"],
                      "map_latency_ratio_with_8_viewers": round(statistics.median(beside) / statistics.median(alone), 3),
                      "rss_per_viewer_mib": round((with_kib - without_kib) / 1024 / (READERS + NEVER), 2),
                      "jobs_beside_viewers": len(beside)}))


main()
