#!/usr/bin/env python3
"""The example program of a line against fvd and the simulated hardware, its connection cut at every point of its loop.

  connection_cuts_test.py FVD FVD_SIM [CUTS]     CUTS: so many, evenly over the loop (12); 0 = after every byte

A part is measured for each cut: after k bytes of a direction, counted from the beginning of the part's loop, both sides of the
connection are reset; every fourth time it falls silent instead. At the end the daemon itself is killed in the middle of a part.
Last line: {"cuts", "repeated_motions", "lost"}.
"""

import contextlib
import importlib.util
import io
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
START_TIMEOUT_S = 60
RECIPE = {
    "format": 2,
    "description": "Small and short: what is tested is the conversation",
    "acquire": {
        "scan": {"start_um": -7, "step_um": 10},
        "camera": {"pixel_format": "Mono8", "exposure_us": 1000, "width_px": 96, "height_px": 64},
    },
    "reconstruct": {
        "focus": {"window_px": 9, "distance_px": 1, "min_prominence": 0.5},
        "lateral": {"pixel_pitch_x_um": 1.0, "pixel_pitch_y_um": 1.0},
    },
}
DIRECTIONS = ("to the daemon", "to the line")


def wait_for(condition, what):
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    sys.exit(f"{what}: not within {START_TIMEOUT_S} s")


class CuttingProxy:
    """Passes bytes on until those of a direction reach a number; then ends that connection, and passes on again."""

    def __init__(self, port):
        self.target = ("127.0.0.1", port)
        self.lock = threading.Lock()
        self.passed = [0, 0]
        self.cut = None
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def arm(self, direction, after_bytes, silent):
        with self.lock:
            self.passed = [0, 0]
            self.cut = (direction, after_bytes, silent)

    def begin_count(self):
        """Without a cut."""
        with self.lock:
            self.passed, self.cut = [0, 0], None

    def accept(self):
        while True:
            near, _ = self.listener.accept()
            try:
                far = socket.create_connection(self.target)
            except OSError:
                near.close()
                continue
            for direction, (source, sink) in enumerate(((near, far), (far, near))):
                threading.Thread(target=self.carry, args=(direction, source, sink), daemon=True).start()

    def carry(self, direction, source, sink):
        silent = False
        with contextlib.suppress(OSError):
            while data := source.recv(4096):
                with self.lock:
                    is_cut = False
                    if self.cut and self.cut[0] == direction and self.passed[direction] + len(data) > self.cut[1]:
                        data = data[: self.cut[1] - self.passed[direction]]
                        is_cut, silent, self.cut = True, self.cut[2], None
                    self.passed[direction] += len(data)
                sink.sendall(data)
                if is_cut:
                    break
            if silent:
                while source.recv(4096):
                    pass
        for end in (source, sink):
            with contextlib.suppress(OSError):
                end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                end.shutdown(socket.SHUT_RDWR)  # wakes the other direction's thread
                end.close()


@contextlib.contextmanager
def instrument(fvd, fvd_sim):
    """(port, restart) of a daemon; restart() kills it and starts it anew on the same port."""
    with tempfile.TemporaryDirectory(prefix="fvd-cuts-") as name, contextlib.ExitStack() as programs:
        folder = pathlib.Path(name)
        (folder / "recipes").mkdir()
        for name, slices in (("part", 5), ("long", 30)):  # long enough for a kill in its middle
            RECIPE["acquire"]["scan"]["slices"] = slices
            (folder / "recipes" / f"{name}.json").write_text(json.dumps(RECIPE))

        def start(log, *command):
            output = programs.enter_context(open(folder / log, "wb"))
            program = subprocess.Popen(command, stdout=output, stderr=output)
            programs.callback(program.wait)
            programs.callback(program.terminate)  # does nothing to one that has ended
            return program

        def document(file, program):
            def look():
                if program.poll() is not None:
                    sys.exit((folder / f"{file.stem}.log").read_text(errors="replace")[-2000:])
                return file.exists() and file.read_text() and json.loads(file.read_text())

            return wait_for(look, str(file))

        program = start("sim.log", fvd_sim, "run", "--camera-address", "auto", "--stage-port", "0", "--ready-file",
                        str(folder / "sim.json"))
        sim = document(folder / "sim.json", program)
        settings = {
            "camera.address": sim["camera_address"],
            "stage.port": sim["stage_port"],
            "rpc.port": 0,
            "rpc.loopback_role": "administer",
            "log.level": "error",
            "paths.state_dir": folder / "state",
            "paths.runtime_dir": folder,
            "paths.recipe_dir": folder / "recipes",
        }

        def start_daemon():
            program = start("rpc.log", fvd, "--config", str(SOURCE / "config/fvd-sim.json"),
                            *(text for key, value in settings.items() for text in ("--set", f"{key}={value}")))
            settings["rpc.port"] = document(folder / "rpc.json", program)["port"]
            return program

        def restart():
            nonlocal program
            program.kill()
            program.wait()
            (folder / "rpc.json").unlink()
            program = start_daemon()

        program = start_daemon()
        yield settings["rpc.port"], restart


def measure_parts(example, proxy, cuts):
    """The results that the example's program printed; cuts: one for each part, None = none. -> (results, cuts that came)"""
    came = 0

    def parts():
        nonlocal came
        for number, cut in enumerate(cuts):
            if cut is None:
                proxy.begin_count()
            else:
                proxy.arm(*cut)
            yield f"part-{number}\n"
            came += cut is not None and proxy.cut is None

    printed = io.StringIO()
    stdin, sys.stdin = sys.stdin, parts()
    try:
        with contextlib.redirect_stdout(printed):
            example.run("127.0.0.1", proxy.port)
    finally:
        sys.stdin = stdin
    return [json.loads(line) for line in printed.getvalue().splitlines()], came


def measure_over_a_kill(example, port, restart):
    """The result of a part in the middle of whose scan the daemon is killed."""
    direct = example.Line("127.0.0.1", port)
    direct.ask("recipe.prepare", id="long")
    newest = direct.ask("system.state")["newest_seq"]
    results = []

    def measure():
        line = example.Line("127.0.0.1", port)
        results.append(line.measure("killed", newest + 1))
        line.ask("result.ack", seq=results[0]["seq"])

    thread = threading.Thread(target=measure)
    thread.start()
    wait_for(lambda: direct.ask("job.latest")["seq"] > newest, "the job has begun")
    restart()
    thread.join(START_TIMEOUT_S)
    assert results, "the part was not measured again"
    assert results[0]["state"] == "completed" and results[0]["part_id"] == "killed", results
    assert results[0]["seq"] == newest + 2, f"its first number is spent: {results}"
    return results[0]


def main(fvd, fvd_sim, wanted="12"):
    spec = importlib.util.spec_from_file_location("line_loop", SOURCE / "daemon/api/examples/line_loop.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    example.POLL_S, example.RETRY_S = 0.1, 0.01
    with instrument(fvd, fvd_sim) as (port, restart):
        direct = example.Line("127.0.0.1", port)
        wait_for(lambda: direct.ask("system.state")["ready"], "the daemon is ready")
        direct.ask("recipe.prepare", id="part")
        proxy = CuttingProxy(port)
        results, _ = measure_parts(example, proxy, [None])
        totals = list(proxy.passed)
        points = [(direction, after) for direction in (0, 1) for after in range(totals[direction])]
        count = int(wanted) or len(points)
        chosen = [points[index * len(points) // count] for index in range(count)]
        # Silence takes the line's own patience to notice.
        example.REPLY_S = 0.4
        more, came = measure_parts(example, proxy, [(*point, index % 4 == 3) for index, point in enumerate(chosen)])
        scans = direct.ask("stage.accuracy")["scans"]
        state = direct.ask("system.state")
        measure_over_a_kill(example, port, restart)
    # The loop's numbers go on over both calls; a result that is there twice, or not at all, breaks the row.
    seqs = [result["seq"] for result in results + more]
    parts = [result["part_id"] for result in more]
    assert [result["state"] for result in results + more] == ["completed"] * len(seqs), results + more
    lost = len(set(parts) ^ {f"part-{number}" for number in range(count)}) + state["results_waiting"]
    doubled = len(parts) - len(set(parts)) + len(seqs) - len(set(seqs)) + state["newest_seq"] - len(seqs)
    figures = {"cuts": came, "repeated_motions": scans - len(seqs), "lost": lost + abs(doubled)}
    print(f"the loop sends {totals[0]} bytes and receives {totals[1]}; {len(seqs)} parts, {scans} scans")
    print(json.dumps(figures), flush=True)
    assert came > 0 and figures["repeated_motions"] == 0 and figures["lost"] == 0, figures


if __name__ == "__main__":
    main(*sys.argv[1:])
