"""What live scans of the simulated microscope show; called by run_truth.sh, prints one JSON object.

Usage: truth_live.py WORK_FOLDER BUILD_FOLDER SOURCE_FOLDER
"""

import json
import pathlib
import signal
import subprocess
import sys
import time

WORK, BUILD, SOURCE = (pathlib.Path(argument) for argument in sys.argv[1:4])
FVD, FVDCTL, SIM = BUILD / "daemon/fvd", BUILD / "daemon/ctl/fvdctl", BUILD / "sim/fvd-sim"
START_TIMEOUT_S = 30
JOB_TIMEOUT_S = 300


def wait_for(file, process):
    """The JSON object in a file that a program writes when it is ready."""
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline and process.poll() is None:
        if file.exists() and file.stat().st_size > 0:
            return json.loads(file.read_text())
        time.sleep(0.05)
    sys.exit(f"{process.args[0]} did not start")


class Microscope:
    """fvd-sim and fvd; each job's result folder."""

    def __init__(self, name, recipe, world=None, camera_faults=None):
        self.folder = WORK / name
        recipes = self.folder / "recipes"
        recipes.mkdir(parents=True)
        (recipes / "part.json").write_text(json.dumps(recipe))
        self.world = []
        if world:
            file = self.folder / "world.json"
            file.write_text(json.dumps(world))
            self.world = ["--world", str(file)]
        simulator = [SIM, "run", *self.world, "--camera-address", "auto", "--stage-port", "0"]
        simulator += ["--ready-file", self.folder / "sim.json"]
        if camera_faults:
            file = self.folder / "camera_faults.json"
            file.write_text(json.dumps(camera_faults))
            simulator += ["--camera-faults", file]
        self.programs = []
        ready = wait_for(self.folder / "sim.json", self.start(simulator, "sim.log"))
        settings = {
            "camera.address": ready["camera_address"],
            "stage.port": ready["stage_port"],
            "rpc.port": 0,
            "paths.state_dir": self.folder / "state",
            "paths.runtime_dir": self.folder / "run",
            "paths.recipe_dir": recipes,
        }
        daemon = [FVD, "--config", SOURCE / "config/fvd-sim.json"]
        for key, value in settings.items():
            daemon += ["--set", f"{key}={value}"]
        wait_for(self.folder / "run/rpc.json", self.start(daemon, "fvd.log"))

    def start(self, command, log):
        with open(self.folder / log, "w") as out:
            self.programs.append(subprocess.Popen([str(word) for word in command], stdout=out, stderr=out))
        return self.programs[-1]

    def rpc(self, method, **params):
        command = [FVDCTL, "--runtime-dir", self.folder / "run", "rpc", method, json.dumps(params)]
        answer = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        return json.loads(answer.stdout) if answer.returncode == 0 else {"error": answer.stderr.strip()}

    def measure(self, seq):
        """Runs a job; returns its result folder."""
        deadline = time.monotonic() + JOB_TIMEOUT_S
        while not self.rpc("system.state").get("ready") and time.monotonic() < deadline:
            time.sleep(0.1)
        job = self.rpc("job.start", seq=seq, part_id="truth", recipe="part")
        while time.monotonic() < deadline:
            job = self.rpc("job.wait", job_id=job["job_id"], timeout_ms=20000)
            if job["state"] != "processing":
                break
        if job["state"] != "completed":
            sys.exit(f"a job ended as {job}")
        return self.folder / "state/results" / job["job_id"]

    def figures(self, result):
        """What fvd-sim evaluate says of a result, against the world."""
        command = [SIM, "evaluate", *self.world, result, "--json"]
        out = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout
        return json.loads(out.strip().splitlines()[-1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for program in reversed(self.programs):
            program.send_signal(signal.SIGTERM)
            program.wait()


def recipe(start_um, step_um, slices, keep_slices=False):
    return {
        "format": 2,
        "acquire": {
            "scan": {"start_um": start_um, "step_um": step_um, "slices": slices},
            "camera": {"pixel_format": "Mono8", "exposure_us": 5000},
        },
        "keep": {"slices": keep_slices},
    }


def dark_slices():
    """A black frame at the first slice, at the one in which the 50 um plateau is nearly in focus."""
    worst_um, retaken = 50.0, 0
    for place in (0, 10):
        faults = [{"fault": "dark_frame", "after": place}]
        with Microscope(f"dark_{place}", recipe(-7, 10, 21), camera_faults=faults) as microscope:
            result = microscope.measure(1)
            step_um = microscope.figures(result)["steps_um"][0]
            if abs(step_um - 50) >= abs(worst_um - 50):
                worst_um = step_um
            slices = json.loads((result / "result.json").read_text())["slices"]
            retaken = max(retaken, slices.get("retaken", 0))
    return {"live_dark_step_um": worst_um, "retaken": retaken}


def bins():
    """Steps of a tenth of the curve's width: the second scan and the recorded slices, over the best bins there are."""
    world = {"surface": "chapter", "width_px": 480, "height_px": 360, "defocus_px_per_um": 0.04, "readout_noise": 1.5}
    world["texture"] = "white"
    with Microscope("bins", recipe(-47, 2.6, 96, keep_slices=True), world) as microscope:
        first, second = microscope.measure(1), microscope.measure(2)

        def rms(result):
            return microscope.figures(result)["plateau_rms_um"]["five_sample"]

        def processed(name, options):
            out = microscope.folder / name
            slices = second / "slices"
            command = [FVDCTL, "process", slices, "--z-file", slices / "z.txt", "--z-unit", "um", "--stage-correction"]
            command = [str(word) for word in [*command, "--out", out, *options]]
            subprocess.run(command, check=True, capture_output=True)
            return rms(out)

        best = min(processed(f"bin_{bin_}", ["--bin", bin_]) for bin_ in range(1, 7))
        warned = any(
            warning["code"] == "bins_unknown"
            for warning in json.loads((first / "result.json").read_text())["warnings"]
        )
        return {
            "auto_bin_first_scan_over_best": rms(first) / best,
            "auto_bin_first_scan_warns": int(warned),
            "auto_bin_over_best": max(rms(second), processed("auto", [])) / best,
        }


print(json.dumps({**dark_slices(), **bins()}))
