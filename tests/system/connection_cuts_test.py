#!/usr/bin/env python3
"""The example program of a line against fvd and the simulated hardware, its connection cut at every point of its loop.

  connection_cuts_test.py FVD FVD_SIM [CUTS]     CUTS: so many, evenly over the loop (12); 0 = after every byte

A part is measured for each cut: after k bytes of a direction, counted from the beginning of the part's loop, both sides of the
connection are reset; every fourth time it falls silent instead. At the end the daemon itself is killed in the middle of a part.
Last line: {"cuts", "cuts_share", "repeated_motions", "lost"}; the share is that of the cuts that came.
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
            example.run("part", "127.0.0.1", proxy.port)  # nobody prepares one
    finally:
        sys.stdin = stdin
    return [json.loads(line) for line in printed.getvalue().splitlines()], came


def measure_over_a_kill(example, port, restart):
    """The result of a part in the middle of whose scan the daemon is killed."""
    direct = example.Line("127.0.0.1", port)
    newest = direct.ask("system.state")["newest_seq"]
    results = []

    def measure():
        line = example.Line("127.0.0.1", port, "long")
        results.append(line.measure("killed", line.begin()))
        line.finish("killed", results[0]["seq"])

    thread = threading.Thread(target=measure, daemon=True)
    thread.start()
    wait_for(lambda: direct.ask("job.latest")["seq"] > newest, "the job has begun")
    restart()
    thread.join(START_TIMEOUT_S)
    assert results, "the part was not measured again"
    assert results[0]["state"] == "completed" and results[0]["part_id"] == "killed", results
    assert results[0]["seq"] == newest + 2, f"its first number is spent: {results}"
    return results[0]


class ScriptedLine:
    """The loop against written replies, [method, reply] each; an int is an error's code."""

    def __init__(self, example, *script):
        self.line, self.script, self.let_go = example.Line("", 0, "by-name"), list(script), []
        self.line.ask, self.line.let_go = self.ask, self.note
        self.line.session = "1"

    def note(self, part):
        self.line.is_free = True
        self.let_go.append(part)

    def ask(self, method, expected=(), **params):
        assert self.script, f"{method} {params} is not in the script"
        wanted, reply = self.script.pop(0)
        assert (method, params.get("seq")) == wanted, f"{method} {params} in place of {wanted}"
        assert method != "job.start" or params["recipe"] == "by-name", f"measured by whatever is prepared: {params}"
        if isinstance(reply, int):
            assert reply in expected, f"{reply} of {method} ends the program"
            return {"code": reply}
        return reply


def job(seq, acquired=False, done=True, error=0, part="p"):
    """Replies to job.status, or to it and result.get where it is done."""
    status = [("job.status", seq), {"acquired": acquired, "done": done}]
    result = [("result.get", seq), {"seq": seq, "part_id": part, "error_code": error}]
    return [status, result] if done else [status]


def check_what_is_rare(example):
    """What a daemon that runs well does not answer."""
    ready = [("system.state", None), {"ready": True, "part_release": True}]
    moving = [("system.state", None), {"ready": False, "part_release": False}]

    def start(seq, reply=None):
        return [("job.start", seq), {} if reply is None else reply]

    def ack(seq):
        return [("result.ack", seq), {}]

    def latest(seq):
        return [("job.latest", None), {"newest_seq": seq}]

    def measured(script, wanted_seq, let_go):
        scripted = ScriptedLine(example, *script)
        result = scripted.line.measure("p", 1)
        assert result["seq"] == wanted_seq and scripted.let_go == let_go and not scripted.script, scripted.script

    measured([ready, start(1), *job(1, True)], 1, ["p"])
    measured([ready, start(1, 1010), *job(1, True)], 1, ["p"])  # the first request had come through long ago
    measured([ready, start(1, 1010), [("job.status", 1), 1007], latest(8), ready, start(9), *job(9, True)], 9, ["p"])
    measured([ready, start(1, 1009), latest(8), ready, start(9), *job(9, True)], 9, ["p"])
    measured([ready, start(1), *job(1, error=1014), ack(1), ready, start(2), *job(2, True)], 2, ["p"])
    measured([ready, start(1, 1014), *job(1, error=1014), ack(1), ready, start(2), *job(2, True)], 2, ["p"])
    # A result that was found after a restart: standstill is not known, but the part was let go before.
    measured([ready, start(1), *job(1, True, False), *job(1)], 1, ["p"])
    scripted = ScriptedLine(example, ready, start(1), *job(1, error=1004), ack(1), moving, moving, ready)
    scripted.line.measure("p", 1)
    assert scripted.let_go == []
    scripted.line.finish("p", 1)
    assert scripted.let_go == ["p"] and not scripted.script, "ended without `acquired`: part_release lets it go"
    for last in (job(1, error=1014), job(1, part="another")):
        scripted = ScriptedLine(example, ready, start(1), *job(1, True, False), *last)
        try:
            scripted.line.measure("p", 1)
        except SystemExit:
            assert not scripted.script
        else:
            raise AssertionError("a part that has left is not measured again, and no other's result is taken")


def main(fvd, fvd_sim, wanted="12"):
    spec = importlib.util.spec_from_file_location("line_loop", SOURCE / "daemon/api/examples/line_loop.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    check_what_is_rare(example)
    example.POLL_S, example.RETRY_S = 0.1, 0.01
    with instrument(fvd, fvd_sim) as (port, restart):
        direct = example.Line("127.0.0.1", port)
        wait_for(lambda: direct.ask("system.state")["ready"], "the daemon is ready")
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
    figures = {"cuts": came, "cuts_share": round(came / count, 3), "repeated_motions": scans - len(seqs),
               "lost": lost + abs(doubled)}
    print(f"the loop sends {totals[0]} bytes and receives {totals[1]}; {len(seqs)} parts, {scans} scans")
    print(json.dumps(figures), flush=True)
    # Polls more or less, as busy as the machine is, move the last bytes: some of a few cuts may find none.
    assert came >= 0.5 * count and figures["repeated_motions"] == 0 and figures["lost"] == 0, figures


if __name__ == "__main__":
    main(*sys.argv[1:])
