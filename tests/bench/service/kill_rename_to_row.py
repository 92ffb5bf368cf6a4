"""Kills of the daemon between a result's rename and its row; called by kill_rename_to_row.sh.

Usage: kill_rename_to_row.py BUILD KILLS SEED. FVD_SIM: another simulator than BUILD's.
A kill counts where the folder could be seen and the row had no end. What the client was told by then, and every folder,
is compared with what the next start makes of it.
"""

import json
import os
import pathlib
import random
import shutil
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time

BUILD, KILLS = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2])
DICE = random.Random(int(sys.argv[3]))
SOURCE = pathlib.Path(__file__).resolve().parents[3]
WAIT_S = 120
CALLS = 14  # that write, from the rename to the row and a little beyond
INTERRUPTED = 1014
RECIPE = {
    "format": 2,
    "acquire": {
        "scan": {"start_um": -7, "step_um": 10, "slices": 9},
        "camera": {"pixel_format": "Mono8", "exposure_us": 2000, "width_px": 160, "height_px": 120},
    },
    "reconstruct": {"focus": {"window_px": 9}, "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0}},
}


class Lost(Exception):
    """The connection was cut."""


def wait_for_file(file, process):
    deadline = time.monotonic() + WAIT_S
    while time.monotonic() < deadline and process.poll() is None:
        if file.exists() and file.stat().st_size > 0:
            return json.loads(file.read_text())
        time.sleep(0.01)
    sys.exit(f"{process.args[0]} did not start: see {file.parent}")


class Client:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=WAIT_S)
        self.lines = self.socket.makefile("r")

    def ask(self, method, **params):
        """The answer: {"result": ..} or {"error": ..}."""
        request = {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}
        try:
            self.socket.sendall((json.dumps(request) + "\n").encode())
            line = self.lines.readline()
        except OSError as error:
            raise Lost from error
        if not line.endswith("\n"):
            raise Lost
        return json.loads(line)

    def await_that(self, method, holds, **params):
        deadline = time.monotonic() + WAIT_S
        while time.monotonic() < deadline:
            answer = self.ask(method, **params).get("result")
            if answer is not None and holds(answer):
                return answer
            time.sleep(0.01)
        sys.exit(f"{method} {params} does not come to what is awaited: {answer}")


class Bench:
    def __init__(self, folder):
        self.folder = folder
        self.results = folder / "state/results"
        (folder / "recipes").mkdir()
        (folder / "recipes/part.json").write_text(json.dumps(RECIPE))
        self.log = open(folder / "fvd.log", "w")
        ready = folder / "sim.json"
        sim = [os.environ.get("FVD_SIM", BUILD / "sim/fvd-sim"), "run", "--camera-address", "auto", "--stage-port", "0",
               "--ready-file", ready]
        self.sim = subprocess.Popen([str(word) for word in sim], stdout=self.log, stderr=self.log)
        self.plant = wait_for_file(ready, self.sim)
        self.daemon = None
        self.figures = dict.fromkeys(
            ("kills_rename_to_row", "half_visible", "orphans_left", "acked_lost", "verdict_changes", "repeated_motions"), 0)

    def close(self):
        for program in (self.daemon, self.sim):
            if program is not None and program.poll() is None:
                program.terminate()
                try:
                    program.wait(20)
                except subprocess.TimeoutExpired:
                    program.kill()

    def start(self, kill_after):
        port_file = self.folder / "run/rpc.json"
        port_file.unlink(missing_ok=True)
        settings = {
            "camera.address": self.plant["camera_address"],
            "stage.port": self.plant["stage_port"],
            "rpc.port": 0,
            "paths.state_dir": self.folder / "state",
            "paths.runtime_dir": self.folder / "run",
            "paths.recipe_dir": self.folder / "recipes",
        }
        command = [BUILD / "daemon/fvd", "--config", SOURCE / "config/fvd-sim.json"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        environment = dict(os.environ, LD_PRELOAD=str(BUILD / "tests/bench/libbench_kill_at_call.so"),
                           FVD_KILL_AFTER=str(kill_after))
        self.daemon = subprocess.Popen([str(word) for word in command], stdout=self.log, stderr=self.log, env=environment)
        return Client(wait_for_file(port_file, self.daemon)["port"])

    def violation(self, key, what):
        self.figures[key] += 1
        print(f"{key}: {what}", flush=True)

    def row_has_no_end(self, seq):
        """As the next start will find it; looked at in a copy."""
        with tempfile.TemporaryDirectory() as copy:
            for name in ("fvd.sqlite", "fvd.sqlite-wal"):
                if (self.folder / "state" / name).exists():
                    shutil.copy(self.folder / "state" / name, copy)
            database = sqlite3.connect(pathlib.Path(copy) / "fvd.sqlite")
            row = database.execute("SELECT ended_utc FROM jobs WHERE seq = ?", (seq,)).fetchone()
            database.close()
        return row is not None and row[0] == ""

    def run_job(self, seq, kill_after):
        """What the client was told until the kill: the job's id, and its end where it saw one."""
        told = {"id": None, "end": None}
        try:
            client = self.start(kill_after)
            client.await_that("system.state", lambda state: state["ready"])
            answer = client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
            if "error" in answer:
                sys.exit(f"job {seq} was refused: {answer}")
            told["id"] = answer["result"]["job_id"]
            told["end"] = client.await_that("job.status", lambda status: status["done"], seq=seq)
            while True:  # the kill comes, or not
                client.ask("system.ping")
                if self.figures_of_files(client, seq):
                    break
                time.sleep(0.01)
        except Lost:
            pass
        if self.daemon.poll() is None:
            self.daemon.kill()
        self.daemon.wait(20)
        return told

    def figures_of_files(self, client, seq):
        """Files that follow are made: nothing more is written."""
        files = client.ask("result.get", seq=seq, format="full").get("result", {}).get("files", [])
        return all(file.get("state") != "pending" for file in files)

    def look(self, client, seq, told):
        status = client.ask("job.status", seq=seq)
        if "error" in status:
            return self.violation("acked_lost", f"seq {seq} was accepted as {told['id']}: {status['error']}")
        status = status["result"]
        if status["job_id"] != told["id"]:
            self.violation("acked_lost", f"seq {seq} was job {told['id']} and is {status['job_id']}")
        if not status["done"]:
            self.violation("half_visible", f"seq {seq} is {status['state']} after a restart")
        end = ("state", "evaluation", "error_code", "reason_codes")
        if told["end"] and any(told["end"].get(key) != status.get(key) for key in end):
            self.violation("verdict_changes", f"seq {seq} ended as {told['end']} and ends as {status}")
        if status["state"] == "completed":
            self.look_at_files(seq, self.results / status["job_id"])
        again = client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
        refused = again.get("error", {}).get("code") == INTERRUPTED and status["error_code"] == INTERRUPTED
        if not refused and not again.get("result", {}).get("duplicate"):
            self.violation("repeated_motions", f"seq {seq}, sent again: {again}")
        return status

    def look_at_files(self, seq, folder):
        try:
            result = json.loads((folder / "result.json").read_text())
            short = [file["name"] for file in result["files"]
                     if file["state"] == "written" and "size_bytes" in file and "files" not in file
                     and (folder / file["name"]).stat().st_size != file["size_bytes"]]
        except (OSError, ValueError) as error:
            short = [str(error)]
        if short:
            self.violation("half_visible", f"seq {seq}: {', '.join(short)}")

    def look_at_folders(self, completed):
        for entry in self.results.iterdir():
            if entry.name not in completed:
                self.violation("orphans_left", str(entry))

    def run(self):
        completed, seq, tries = set(), 0, 0
        while self.figures["kills_rename_to_row"] < KILLS:
            tries += 1
            if tries > 4 * KILLS + 20:
                sys.exit(f"only {self.figures['kills_rename_to_row']} of {tries} kills came between rename and row")
            seq += 1
            told = self.run_job(seq, DICE.randrange(CALLS))
            if told["id"] is None:
                continue  # killed before it answered: nothing was promised
            between = (self.results / told["id"]).exists() and self.row_has_no_end(seq)
            client = self.start(10**9)
            client.await_that("system.state", lambda state: state["ready"])
            status = self.look(client, seq, told)
            if status and status["state"] == "completed":
                completed.add(status["job_id"])
                answer = client.ask("result.ack", seq=seq)
                if "error" in answer:
                    sys.exit(f"the result of {seq} is not acknowledged: {answer['error']}")
            self.look_at_folders(completed)
            self.daemon.terminate()
            self.daemon.wait(WAIT_S)
            self.figures["kills_rename_to_row"] += 1 if between else 0
        print(json.dumps(self.figures))
        return all(value == 0 for key, value in self.figures.items() if key != "kills_rename_to_row")


with tempfile.TemporaryDirectory() as scratch:
    bench = Bench(pathlib.Path(scratch))
    try:
        good = bench.run()
    finally:
        bench.close()
sys.exit(0 if good else 1)
