"""fvd beside fvd-sim as programs of their own, as the phases of run_service.sh start and ask them.

Times are CLOCK_MONOTONIC in seconds, which fvd-sim writes into its motion log, too.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[3]
# Shorter in a test that is ended as a whole: it has to say what it waited for.
START_TIMEOUT_S = ANSWER_TIMEOUT_S = int(os.environ.get("FVD_SERVICE_TIMEOUT_S", "300"))
# Small images and few slices: what is measured is the service, not the focus.
RECIPE = {
    "format": 2,
    "description": "For the benchmark of the service",
    "acquire": {
        "scan": {"start_um": -7, "step_um": 10, "slices": 9},
        "camera": {"pixel_format": "Mono8", "exposure_us": 1000, "width_px": 96, "height_px": 64},
    },
    "reconstruct": {
        "focus": {"window_px": 9, "distance_px": 1, "min_prominence": 0.5},
        "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0},
    },
}


def recipe(**scan):
    """The recipe above with another scan."""
    made = json.loads(json.dumps(RECIPE))
    made["acquire"]["scan"].update(scan)
    return made


def percentile(values, fraction):
    return sorted(values)[min(len(values) - 1, int(fraction * len(values)))]


def wait_for(condition, within_s=START_TIMEOUT_S, period_s=0.005, what="a condition"):
    """What `condition` returns as soon as that is true; ends the program if it never is."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(period_s)
    sys.exit(f"{what}: not within {within_s} s")


def late_slices(result):
    """Of a result in full: frames that did not come in time, slices that lack or were taken again."""
    frames, slices = result["frames"], result["slices"]
    return (sum(frames[key] for key in ("incomplete", "missing", "stale", "underrun"))
            + slices["planned"] - slices["measured"] + slices["retaken"])


def memory_kib(pid):
    """In all ("VmRSS"), and what of it is "RssAnon": its own; "RssFile": programs and files that are mapped."""
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        words = [line.split() for line in status if line.startswith(("VmRSS", "Rss"))]
    return {key.rstrip(":"): int(kib) for key, kib, _ in words}


def resident_kib(pid):
    return memory_kib(pid)["VmRSS"]


class Answer(Exception):
    """An error that fvd answered; `code` as documented."""

    def __init__(self, error):
        super().__init__(f"{error['code']}: {error['message']}")
        self.code = error["code"]


class Lost(Exception):
    """The connection ended before the answer."""


class Client:
    """One connection, to a TCP port or a unix socket."""

    def __init__(self, where):
        try:
            if isinstance(where, int):
                self.socket = socket.create_connection(("127.0.0.1", where), timeout=ANSWER_TIMEOUT_S)
                self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            else:
                self.socket = socket.socket(socket.AF_UNIX)
                self.socket.settimeout(ANSWER_TIMEOUT_S)
                self.socket.connect(str(where))
        except OSError as error:
            raise Lost(str(error)) from error
        self.lines = self.socket.makefile("rb")

    def send(self, method, **params):
        """The moment before the line was given to the system."""
        line = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}) + "\n"
        sent = time.monotonic()
        try:
            self.socket.sendall(line.encode())
        except OSError as error:
            raise Lost(str(error)) from error
        return sent

    def receive(self):
        try:
            line = self.lines.readline()
        except OSError as error:
            raise Lost(str(error)) from error
        if not line.endswith(b"\n"):
            raise Lost("closed")
        answer = json.loads(line)
        if "error" in answer:
            raise Answer(answer["error"])
        return answer["result"]

    def ask(self, method, **params):
        self.send(method, **params)
        return self.receive()

    def close(self):
        self.lines.close()
        self.socket.close()


class Camera:
    """The simulated camera's control register, read by whoever asks."""

    REGISTER = 0x0A00  # control channel privilege

    def __init__(self, address):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((address, 3956))
        self.socket.settimeout(0.5)
        self.request = 0

    def controlled(self):
        self.request = self.request % 0xFFFF + 1
        self.socket.send(struct.pack(">BBHHHI", 0x42, 1, 0x0080, 4, self.request, self.REGISTER))
        try:
            answer = self.socket.recv(576)
        except TimeoutError:
            return True
        status, _, length, _ = struct.unpack(">HHHH", answer[:8])
        return status != 0 or length != 4 or struct.unpack(">I", answer[8:12])[0] != 0


class Rig:
    """A folder with fvd-sim and, once started, fvd. `simulation`: more words for fvd-sim run."""

    def __init__(self, build, recipes=None, folder=None, simulation=()):
        self.build = pathlib.Path(build).resolve()
        self.own_folder = folder is None
        self.folder = pathlib.Path(folder or tempfile.mkdtemp(prefix="fvd-service-"))
        (self.folder / "recipes").mkdir(parents=True, exist_ok=True)
        for name, document in (recipes or {"part": RECIPE}).items():
            (self.folder / "recipes" / f"{name}.json").write_text(json.dumps(document))
        # In memory: the stage's line waits for each of its lines, and must not for a busy disk.
        self.memory = pathlib.Path(tempfile.mkdtemp(prefix="fvd-motions-", dir="/dev/shm"))
        self.settings = {}
        self.environment = []
        self.daemon = None
        self.simulator = None
        self.port = 0
        try:
            self.simulator = self.run(
                [self.build / "sim/fvd-sim", "run", "--camera-address", "auto", "--stage-port", "0",
                 "--ready-file", self.folder / "sim.json", "--motion-log", self.memory / "motion.txt", *simulation],
                "sim.log")
            self.plant = self.await_file(self.folder / "sim.json", self.simulator)
        except BaseException:  # also Ctrl-C: nothing may be left
            if self.simulator:
                self.simulator.kill()
                self.simulator.wait()
            shutil.rmtree(self.memory, ignore_errors=True)
            raise

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        for program in (self.daemon, self.simulator):
            if program and program.poll() is None:
                program.terminate()
                try:
                    program.wait(30)
                except subprocess.TimeoutExpired:
                    program.kill()
                    program.wait()
        if kind is not None:
            print(f"see {self.folder} and {self.memory}", file=sys.stderr)
        elif self.own_folder:
            shutil.rmtree(self.folder)
        if kind is None:
            shutil.rmtree(self.memory, ignore_errors=True)

    def run(self, command, log):
        with open(self.folder / log, "ab") as out:
            return subprocess.Popen([str(word) for word in command], stdout=out, stderr=out)

    @staticmethod
    def await_file(file, process):
        def text():
            if process.poll() is not None:
                sys.exit(f"{process.args} ended with {process.returncode}: see {file.parent}")
            return file.exists() and file.read_text()

        return json.loads(wait_for(text, what=str(file)))

    @property
    def socket(self):
        return self.folder / "run/fvd.sock"

    @property
    def state(self):
        return self.folder / "state"

    def configure(self):
        """Writes fvd.json: that of the simulation with what is special here."""
        text = (SOURCE / "config/fvd-sim.json").read_text()
        config = json.loads(re.sub(r"//[^\n]*", "", text))
        config.pop("$schema")
        settings = {
            "camera.address": self.plant["camera_address"],
            "stage.port": self.plant["stage_port"],
            "stage.profile": str(SOURCE / "config/drives/oriental-az.json"),
            # A busy machine makes the simulator slow, which is no fault that is looked for here.
            "stage.response_timeout_ms": 2000,
            "camera.silence_ms": 5000,
            "camera.frame_margin_ms": 3000,
            "rpc.port": 0,
            "rpc.loopback_role": "administer",
            "paths.state_dir": str(self.state),
            "paths.runtime_dir": str(self.folder / "run"),
            "paths.recipe_dir": str(self.folder / "recipes"),
            **self.settings,
        }
        for key, value in settings.items():
            group, name = key.split(".")
            config.setdefault(group, {})[name] = value
        (self.folder / "fvd.json").write_text(json.dumps(config, indent=2))

    def spawn(self):
        """Starts fvd and waits for nothing; the moment of it."""
        (self.folder / "run/rpc.json").unlink(missing_ok=True)
        self.configure()
        begun = time.monotonic()
        self.daemon = self.run(["env", *self.environment, self.build / "daemon/fvd", "--config", self.folder / "fvd.json"],
                               "fvd.log")
        return begun

    def await_port(self):
        self.port = self.await_file(self.folder / "run/rpc.json", self.daemon)["port"]

    def start(self):
        """Starts fvd; a client of it once it is ready."""
        begun = self.spawn()
        self.await_port()
        client = Client(self.port)
        wait_for(lambda: client.ask("system.state")["ready"], what=f"ready, see {self.folder}")
        self.ready_after_s = time.monotonic() - begun
        return client

    def kill(self):
        self.daemon.send_signal(signal.SIGKILL)
        self.daemon.wait()

    def stop(self):
        self.daemon.terminate()
        if self.daemon.wait(60) != 0:
            sys.exit(f"fvd ended with {self.daemon.returncode}: see {self.folder}")

    def fvdctl(self, *words):
        return subprocess.run([str(word) for word in (self.build / "daemon/ctl/fvdctl", *words)], check=False,
                              capture_output=True, text=True)

    def motions(self):
        return Motions(self.memory / "motion.txt")


class Motions:
    """Follows fvd-sim's motion log; `lines` are pairs of a time in s and words."""

    def __init__(self, file):
        self.file = open(file, encoding="ascii")
        self.partial = ""
        self.lines = []

    def read(self):
        """What came since the last call."""
        *whole, self.partial = (self.partial + self.file.read()).split("\n")
        new = []
        for line in whole:
            ns, words = line.split(" ", 1)
            new.append((int(ns) / 1e9, words))
        self.lines += new
        return new

    def await_line(self, begin, since, within_s=20):
        """The time of the first line since `since` that begins so."""
        def found():
            self.read()
            return next((at for at, words in self.lines if at >= since and words.startswith(begin)), None)

        return wait_for(found, within_s, 0.001, f"the stage's '{begin}'")

    def moving(self):
        self.read()
        last = next((words for _, words in reversed(self.lines) if words in ("moving", "still")), "still")
        return last == "moving"

    def intervals(self):
        """From when until when the stage truly moved, in s; an open one ends never."""
        self.read()
        found, since = [], None
        for at, words in self.lines:
            if words == "moving":
                since = at
            elif words == "still" and since is not None:
                found.append((since, at))
                since = None
        return found + ([(since, float("inf"))] if since is not None else [])
