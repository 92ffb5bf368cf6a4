"""Artefacts of known dimensions through fvd-sim render and fvdctl process; for metrology_figures.py."""

import concurrent.futures
import itertools
import json
import pathlib
import shutil
import subprocess

import numpy as np


class Plant:
    """The programs of one build, and a folder for what they make."""

    def __init__(self, work, build, root):
        self.work = pathlib.Path(work)
        self.sim = str(pathlib.Path(build) / "sim/fvd-sim")
        self.fvdctl = str(pathlib.Path(build) / "daemon/ctl/fvdctl")
        self.root = pathlib.Path(root)
        self.counter = itertools.count(1)

    def run(self, *command, good=(0, 2, 3, 4)):
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True, errors="replace")
        if done.returncode not in good:
            raise RuntimeError(f"{' '.join(map(str, command))}\nexit {done.returncode}: {done.stderr[-800:]}")
        return done

    def many(self, work, arguments):
        """work(argument) for each of them, two at a time, in their order."""
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            return list(pool.map(work, arguments))

    def world(self, name, changes=None):
        """A world of sim/worlds, with groups of it changed."""
        file = self.root / "sim/worlds" / f"{name}.json"
        if not changes:
            return file
        world = json.loads(file.read_text())
        for group, members in changes.items():
            if isinstance(members, dict):
                world.setdefault(group, {}).update(members)
            else:
                world[group] = members
        made = self.work / f"world_{next(self.counter)}.json"
        made.write_text(json.dumps(world))
        return made

    def evaluated(self, name, evaluation, seed=1, window=None):
        """The evaluation alone; nothing stays on the disk."""
        made, out, slices = self.measured(name, evaluation, seed, window)
        shutil.rmtree(out)
        shutil.rmtree(slices)
        return made

    def measured(self, name, evaluation, seed=1, window=None, changes=None):
        """(evaluation of the result, folder of the result, folder of slices and truth)"""
        run = next(self.counter)
        slices = self.work / f"slices_{run}"
        out = self.work / f"result_{run}"
        self.run(self.sim, "render", self.world(name, changes), slices, "--seed", seed, "--format", "pgm")
        z = np.loadtxt(slices / "z.txt", ndmin=1)
        focus = {"curve_width_um": 28}
        focus.update(window or {"window": "box", "window_px": 9})
        recipe = self.recipe(out, evaluation, {"start_um": float(z[0]), "step_um": float(z[1] - z[0]), "slices": len(z)}, focus)
        self.run(self.fvdctl, "process", slices, "--recipe", recipe, "--out", out)
        return json.loads((out / "result.json").read_text())["evaluation"], out, slices

    def recipe(self, beside, evaluation, scan=None, focus=None):
        file = beside.with_name(f"recipe_of_{beside.name}.json")
        file.write_text(json.dumps({
            "format": 2,
            "acquire": {"scan": scan or {"start_um": 0, "step_um": 10, "slices": 21}},
            "reconstruct": {"focus": focus or {}, "lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
            "evaluation": evaluation,
        }))
        return file

    def of_file(self, file, evaluation):
        """The evaluation of a surface's file."""
        return json.loads(self.run(self.fvdctl, "measure", file, "--recipe", self.recipe(file, evaluation), "--json").stdout)

    def truth(self, slices):
        file = slices / "truth.json"
        return json.loads((file if file.exists() else slices / "truth/truth.json").read_text())


def value(evaluation, measurement, key):
    """(value, U) of a value; None where it is absent."""
    found = evaluation["measurements"][measurement]["values"][key]
    return found.get("value"), found.get("U")


def gsf(path):
    """Heights in um of a GSF file."""
    data = path.read_bytes()
    end = data.index(b"\0")
    header = dict(line.split(" = ", 1) for line in data[:end].decode().splitlines()[1:])
    width, height = int(header["XRes"]), int(header["YRes"])
    return np.frombuffer(data[-4 * width * height:], "<f4").reshape(height, width).astype(float) * 1e6


def write_gsf(path, z_um, pitch_um=1.0):
    """Heights in um, NaN where there is none."""
    height, width = z_um.shape
    head = (f"Gwyddion Simple Field 1.0\nXRes = {width}\nYRes = {height}\nXReal = {width * pitch_um:.9g}e-6\n"
            f"YReal = {height * pitch_um:.9g}e-6\nXYUnits = m\nZUnits = m\n").encode()
    path.write_bytes(head + b"\0" * (4 - len(head) % 4) + (z_um * 1e-6).astype("<f4").tobytes())
    return path


def box_mean(plane, side):
    """Mean over a square window; only points whose window lies in the plane."""
    sums = np.cumsum(np.cumsum(np.pad(plane, ((1, 0), (1, 0))), 0), 1)
    return (sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]) / side**2
