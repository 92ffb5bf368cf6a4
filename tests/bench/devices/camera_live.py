"""What fvd does beside a simulated camera that is busy, silent, or whose clock is set; called by camera.sh.

Usage: camera_live.py WORK_FOLDER BUILD_FOLDER SOURCE_FOLDER DRIVER_FIGURES [PART ...]
DRIVER_FIGURES: output of `bench_camera devices`, whose last line is merged into the object that is printed. PART: one or
more of abort, busy, pending, silence, idle, no_frames; default: all.
"""

import json
import pathlib
import signal
import socket
import subprocess
import sys
import time

WORK, BUILD, SOURCE, FIGURES = (pathlib.Path(argument) for argument in sys.argv[1:5])
PARTS = sys.argv[5:] or ["abort", "busy", "pending", "silence", "idle", "no_frames"]
FVD, SIM = BUILD / "daemon/fvd", BUILD / "sim/fvd-sim"
START_TIMEOUT_S = 60
JOB_TIMEOUT_S = 120
JOBS = 20
# A scan of half a second and more, small enough that computing is no matter.
RECIPE = {
    "format": 2,
    "description": "For the benchmark of faults",
    "acquire": {
        "scan": {"start_um": -7, "step_um": 10, "slices": 21},
        "camera": {"pixel_format": "Mono8", "exposure_us": 2000, "width_px": 160, "height_px": 120},
    },
    "reconstruct": {"focus": {"window_px": 9}, "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0}},
}
FOREVER = 1_000_000
# Faults that last until the job is aborted, beginning in the middle of a scan: name, step of the script.
LASTING = {
    "none": None,
    **{
        fault: {"fault": fault, "count": FOREVER}
        for fault in (
            "drop_leader drop_trailer drop_frame drop_ack ignore_trigger nack_trigger duplicate_frame reorder_packets "
            "wrong_size too_long early_leader ids_restart stale_frame dark_frame half_frame busy other_format "
            "forget_stream chunk_mode"
        ).split()
    },
    "drop_packet": {"fault": "drop_packet", "count": FOREVER, "value": 1},
    "id_jump": {"fault": "id_jump", "count": FOREVER, "value": 7},
    "padded_lines": {"fault": "padded_lines", "count": FOREVER, "value": 8},
    "late_frame": {"fault": "late_frame", "count": FOREVER, "delay_ms": 400},
    "mute": {"fault": "mute", "delay_ms": 60000},
    "hang": {"fault": "hang", "delay_ms": 60000},
    "restart": {"fault": "restart", "delay_ms": 60000},
    "pending_ack": {"fault": "pending_ack", "count": FOREVER, "delay_ms": 2000, "value": 4000},
    "odd_time_ahead": {"fault": "odd_time", "count": FOREVER, "step_ms": 3_600_000},
    "odd_time_back": {"fault": "odd_time", "count": FOREVER, "step_ms": -3_600_000},
    "clock_step_ahead": {"fault": "clock_step", "count": FOREVER, "step_ms": 3_600_000},
    "clock_step_back": {"fault": "clock_step", "count": FOREVER, "step_ms": -1000},
}


def wait_for_file(file, process):
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline and process.poll() is None:
        if file.exists() and file.stat().st_size > 0:
            return json.loads(file.read_text())
        time.sleep(0.02)
    sys.exit(f"{process.args[0]} did not start: see {file.parent}")


class Rig:
    """fvd, and fvd-sim as its stage and camera, or a second one as the camera alone."""

    def __init__(self, name, camera_faults=(), own_camera=False):
        self.folder = WORK / name
        (self.folder / "recipes").mkdir(parents=True)
        (self.folder / "recipes/part.json").write_text(json.dumps(RECIPE))
        (self.folder / "faults.json").write_text(json.dumps(list(camera_faults)))
        self.programs = []
        plant = self.simulator("stage")
        self.camera = self.programs[-1]
        address = plant["camera_address"]
        if own_camera:
            address = self.simulator("camera")["camera_address"]
            self.camera = self.programs[-1]
        settings = {
            "camera.address": address,
            "stage.port": plant["stage_port"],
            "rpc.port": 0,
            "paths.state_dir": self.folder / "state",
            "paths.runtime_dir": self.folder / "run",
            "paths.recipe_dir": self.folder / "recipes",
        }
        command = [FVD, "--config", SOURCE / "config/fvd-sim.json"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        self.daemon = self.start(command, "fvd.log")
        port = wait_for_file(self.folder / "run/rpc.json", self.daemon)["port"]
        self.connection = socket.create_connection(("127.0.0.1", port), timeout=JOB_TIMEOUT_S)
        self.lines = self.connection.makefile("r")
        self.seq = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()
        for program in reversed(self.programs):
            if program.poll() is None:
                program.send_signal(signal.SIGCONT)
                program.terminate()
                try:
                    program.wait(20)
                except subprocess.TimeoutExpired:
                    program.kill()

    def start(self, command, log):
        with open(self.folder / log, "w") as out:
            self.programs.append(subprocess.Popen([str(word) for word in command], stdout=out, stderr=out))
        return self.programs[-1]

    def simulator(self, name):
        ready = self.folder / f"{name}.json"
        command = [SIM, "run", "--camera-address", "auto", "--stage-port", "0", "--ready-file", ready]
        command += ["--camera-faults", self.folder / "faults.json"]
        return wait_for_file(ready, self.start(command, f"{name}.log"))

    def rpc(self, method, **params):
        request = {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}
        self.connection.sendall((json.dumps(request) + "\n").encode())
        answer = json.loads(self.lines.readline())
        return answer.get("result", answer.get("error"))

    def await_ready(self, wanted=True, within_s=START_TIMEOUT_S):
        deadline = time.monotonic() + within_s
        while time.monotonic() < deadline:
            if self.rpc("system.state").get("ready", False) == wanted:
                return True
            time.sleep(0.01)
        return False

    def begin(self):
        self.seq += 1
        return self.rpc("job.start", seq=self.seq, part_id="part", recipe="part")

    def status(self):
        return self.rpc("job.status", seq=self.seq)

    def await_end(self):
        deadline = time.monotonic() + JOB_TIMEOUT_S
        while time.monotonic() < deadline:
            status = self.status()
            if status.get("done", True):
                return status
            time.sleep(0.003)
        sys.exit(f"a job does not end: {status}")

    def await_slices(self, slices, within_s=3.0):
        """Until so many slices are there, or the job has ended, or the time is over: the fault may hold it up."""
        deadline = time.monotonic() + within_s
        while time.monotonic() < deadline:
            status = self.status()
            if status.get("done", True) or status.get("slices_done", 0) >= slices:
                return
            time.sleep(0.003)

    def job(self):
        """State and error of one job."""
        self.await_ready()
        self.begin()
        end = self.await_end()
        return end.get("state"), end.get("error"), end.get("error_message", "")


def ms_since(begin):
    return (time.monotonic() - begin) * 1000.0


def aborts():
    """The longest from job.abort to the job's end, and from SIGTERM to the exit, in the middle of every lasting fault."""
    longest, exit_ms = 0.0, 0.0
    for name, step in LASTING.items():
        faults = [] if step is None else [dict(step, after=40 if step["fault"] in ("drop_ack", "busy", "pending_ack") else 6)]
        with Rig(f"abort-{name}", faults) as rig:
            rig.await_ready()
            rig.begin()
            rig.await_slices(5)
            time.sleep(0.1)  # into the fault, whatever it does
            running = not rig.status().get("done", True)
            begin = time.monotonic()
            rig.rpc("job.abort", seq=rig.seq)
            end = rig.await_end()
            abort_ms = ms_since(begin)
            if rig.await_ready(within_s=3.0):
                rig.begin()
                rig.await_slices(2, 1.0)
            begin = time.monotonic()
            rig.daemon.send_signal(signal.SIGTERM)
            try:
                rig.daemon.wait(60)
            except subprocess.TimeoutExpired:
                pass
            term_ms = ms_since(begin)
        longest, exit_ms = max(longest, abort_ms), max(exit_ms, term_ms)
        print(
            f"abort in {name:18}: {'running' if running else 'ended before'}, {abort_ms:6.0f} ms to {end.get('state')} "
            f"{end.get('error') or ''}; SIGTERM {term_ms:6.0f} ms, exit {rig.daemon.returncode}",
            flush=True,
        )
    return {"longest_wait_after_abort_ms": round(longest), "sigterm_exit_ms": round(exit_ms)}


def jobs_ok(name, faults):
    ok = 0
    with Rig(name, faults) as rig:
        for i in range(JOBS):
            state, error, message = rig.job()
            ok += state == "completed"
            if state != "completed":
                print(f"{name}: job {i + 1} {state}, {error}: {message}", flush=True)
    print(f"{name}: {ok} of {JOBS} jobs completed", flush=True)
    return ok


def idle_loss():
    """The longest from the moment at which an idle camera stops to answer to `ready: false`."""
    longest = 0.0
    with Rig("idle", own_camera=True) as rig:
        for i in range(5):
            rig.await_ready()
            time.sleep(0.5 + 0.13 * i)  # at another moment between two looks
            rig.camera.send_signal(signal.SIGSTOP)
            begin = time.monotonic()
            noticed = rig.await_ready(wanted=False, within_s=30.0)
            longest = max(longest, ms_since(begin) if noticed else 1e9)
            print(f"idle: noticed after {ms_since(begin):.0f} ms", flush=True)
            rig.camera.send_signal(signal.SIGCONT)
    return round(longest)


def no_frames():
    """Of ten losses of the stream alone, those that are told as such and followed by a job that completes."""
    recovered = 0
    with Rig("no-frames", [{"fault": "forget_stream", "after": 12}] + [{"fault": "forget_stream", "after": 45}] * 9) as rig:
        for _ in range(60):
            if recovered == 10:
                break
            state, error, message = rig.job()
            if state == "completed":
                continue
            after = rig.job()
            print(f"no frames: {error}: {message}; then {after[0]}", flush=True)
            recovered += error == "camera_no_frames" and after[0] == "completed"
    return recovered


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    text = FIGURES.read_text().rstrip("\n").rsplit("\n", 1)[-1] if FIGURES.exists() else "{}"
    figures = {}
    if "abort" in PARTS:
        figures.update(aborts())
    if "busy" in PARTS:
        figures["gvcp_busy5_jobs_ok_of_20"] = jobs_ok("busy", [{"fault": "busy", "after": 19}] * 3000)
    if "pending" in PARTS:
        step = {"fault": "pending_ack", "after": 25, "delay_ms": 350, "value": 700}
        figures["pending_ack_ok_of_20"] = jobs_ok("pending", [step] * 200)
    if "silence" in PARTS:
        step = {"fault": "mute", "on": "trigger", "after": 17, "delay_ms": 600}
        figures["silence600_jobs_ok_of_20"] = jobs_ok("silence", [step] * 60)
    if "idle" in PARTS:
        figures["idle_camera_loss_ms"] = idle_loss()
    if "no_frames" in PARTS:
        figures["no_frames_recovered_of_10"] = no_frames()
    print(json.dumps({**figures, **json.loads(text)}))


main()
