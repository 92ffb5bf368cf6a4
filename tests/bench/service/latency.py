#!/usr/bin/env python3
"""How soon the stage does what a client asks: a trigger, a stop without control, the end of a jog.

latency.py BUILD trigger|stop|jog|all [ROUNDS]
Prints a line of details and, last, one JSON object.
"""

import json
import os
import random
import sys
import time

from rig import Answer, Client, Rig, percentile, recipe, wait_for

BUSY = 1002
NO_CONTROL = 1003
ROW_BYTES = 24 << 10  # six pages of the write-ahead log


def trigger(build, rounds):
    """From the line given to the system to the first command at the stage; the job's row is made durable in between.

    Beside it, each time, what bounds it: a call that needs no disk, and as much as a row of a job written to a file and
    made durable without fvd.
    """
    times_ms, reply_ms, ping_ms, disk_ms = [], [], [], []
    with Rig(build) as rig, open(os.path.join(rig.folder, "as-a-row"), "wb", buffering=0) as beside:
        client = rig.start()
        motions = rig.motions()
        for seq in range(1, rounds + 1):
            sent = client.send("job.start", seq=seq, part_id="part", recipe="part")
            client.receive()
            reply_ms.append(1000 * (time.monotonic() - sent))
            first = motions.await_line("move" if seq > 1 else "home", sent)
            times_ms.append(1000 * (first - sent))
            if client.ask("job.wait", seq=seq)["state"] != "completed":
                sys.exit(f"a job does not complete: see {rig.folder}")
            client.ask("result.ack", seq=seq)
            begun = time.monotonic()
            client.ask("system.ping")
            ping_ms.append(1000 * (time.monotonic() - begun))
            time.sleep(0.05)  # what the acknowledgement left to write is written
            begun = time.monotonic()
            os.pwrite(beside.fileno(), b"x" * ROW_BYTES, 0)
            os.fdatasync(beside.fileno())
            disk_ms.append(1000 * (time.monotonic() - begun))
    times_ms = times_ms[1:]  # the first one homes
    print(f"trigger: median {percentile(times_ms, 0.5):.2f}, p90 {percentile(times_ms, 0.9):.2f}, "
          f"longest {max(times_ms):.2f} ms of {len(times_ms)}; the reply, which the disk bounds, median "
          f"{percentile(reply_ms, 0.5):.2f}, p99 {percentile(reply_ms, 0.99):.2f} ms; a ping {percentile(ping_ms, 0.5):.2f}, "
          f"p99 {percentile(ping_ms, 0.99):.2f} ms; {ROW_BYTES >> 10} KiB made durable without fvd "
          f"{percentile(disk_ms, 0.5):.2f}, p99 {percentile(disk_ms, 0.99):.2f} ms")
    return {"trigger_p99_ms": round(percentile(times_ms, 0.99), 2), "triggers": len(times_ms)}


def demand_no_control(client):
    """Ends the program unless the client is refused what needs control: else its stops would tell nothing."""
    try:
        client.ask("stage.move", z_um=0)
    except Answer as error:
        if error.code == NO_CONTROL:
            return
        sys.exit(f"the client without control is refused for another reason: {error}")
    sys.exit("the client without control may move the stage")


def stop(build, rounds):
    """From the line of a client without control to the stop at the stage, while another has control and scans."""
    to_stage_ms, to_still_ms, to_reply_ms = [], [], []
    pick = random.Random(1)
    scan = recipe(mode="continuous", start_um=-200, step_um=2, slices=201, speed_um_per_s=200, allowed_lost_slices=190)
    with Rig(build, {"long": scan}) as rig:
        owner = rig.start()
        motions = rig.motions()
        # Control belongs to an identity: another TCP connection from this address would have it, too.
        stranger = Client(rig.socket)
        owner.ask("stage.home")
        owner.ask("control.acquire", owner="line", lease_s=600)
        demand_no_control(stranger)
        for seq in range(1, rounds + 1):
            owner.ask("control.acquire", owner="line", lease_s=600)
            begun = owner.send("job.start", seq=seq, part_id="part", recipe="long")
            owner.receive()
            motions.await_line("moving", begun)
            time.sleep(pick.uniform(0.05, 1.0))  # into the travel to the first slice, or the scan
            wait_for(motions.moving, 20, 0.0005, "a motion")
            sent = stranger.send("stage.stop")
            stranger.receive()
            to_reply_ms.append(1000 * (time.monotonic() - sent))
            to_stage_ms.append(1000 * (motions.await_line("stop", sent) - sent))
            to_still_ms.append(1000 * (motions.await_line("still", sent) - sent))
            owner.ask("job.wait", seq=seq)
            wait_for(lambda: owner.ask("system.state")["ready"], what="ready")
        stranger.close()
    print(f"stop: at the stage median {percentile(to_stage_ms, 0.5):.1f}, p99 {percentile(to_stage_ms, 0.99):.1f} ms; "
          f"reply p99 {percentile(to_reply_ms, 0.99):.1f} ms; standstill p99 {percentile(to_still_ms, 0.99):.1f}, "
          f"longest {max(to_still_ms):.1f} ms of {rounds}")
    return {"stop_without_lease_ms": round(percentile(to_still_ms, 0.99), 1), "stops": rounds}


def hold(client, motions, direction):
    """Holds a jog's key, 100 ms between repeats, as a page does; the time of the last repeat, and 100 ms have gone since."""
    for _ in range(4):
        last = client.send("stage.jog", direction=direction, speed_um_per_s=1000)
        client.receive()
        motions.await_line("moving", last - 0.5)
        time.sleep(max(0.0, last + 0.1 - time.monotonic()))
    return last


def jog(build, rounds):
    """From the last repeat to the true standstill, at the highest speed of a jog."""
    overruns_ms, late = [], 0
    with Rig(build) as rig:
        client = rig.start()
        motions = rig.motions()
        client.ask("stage.home")
        for i in range(3 * rounds):
            if len(overruns_ms) == rounds:
                break
            client.ask("stage.move", z_um=-450 if i % 2 == 0 else 450)
            try:
                last = hold(client, motions, "up" if i % 2 == 0 else "down")
            except Answer as error:
                if error.code != BUSY:
                    raise
                wait_for(lambda: client.ask("system.state")["ready"], what="ready")
                late += 1
                continue  # this client came too late on a busy machine: the jog had ended, and the stage braked
            # The last one was sent 100 ms ago.
            still = motions.await_line("still", last)
            overruns_ms.append(1000 * (still - last))
            wait_for(lambda: client.ask("system.state")["ready"], what="ready")
    print(f"jog: overrun median {percentile(overruns_ms, 0.5):.1f} ms of {len(overruns_ms)}; {late} repeats came too late")
    return {"jog_overrun_ms": round(max(overruns_ms), 1), "jogs": len(overruns_ms)}


def main():
    build, phase = sys.argv[1:3]
    figures = {}
    for name, measured, rounds in (("trigger", trigger, 401), ("stop", stop, 100), ("jog", jog, 40)):
        if phase in (name, "all"):
            figures |= measured(build, int(sys.argv[3]) if len(sys.argv) > 3 else rounds)
    print(json.dumps(figures))


main()
