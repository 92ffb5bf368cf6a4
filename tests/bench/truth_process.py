"""Lets fvdctl process a folder of slices and reads what came out; for truth_figures.py."""

import functools
import json
import pathlib
import re
import subprocess

import cv2
import numpy as np


class Program:
    """One build of fvdctl. Options it does not know are left out, so that earlier versions can be measured too."""

    def __init__(self, fvdctl, work):
        self.fvdctl = str(fvdctl)
        self.work = pathlib.Path(work)
        self.runs = 0

    @functools.cached_property
    def options(self):
        text = subprocess.run([self.fvdctl, "process", "--help"], capture_output=True, text=True).stdout
        return set(re.findall(r"^  (--[a-z-]+)", text, re.MULTILINE))

    @functools.cached_property
    def lost_allowed(self):
        """A recipe under which slices may be left out."""
        file = self.work / "lost_allowed.json"
        scan = {"start_um": 0, "step_um": 10, "slices": 21, "allowed_lost_slices": 4}
        # As without a recipe, but for that.
        focus = {"stage_correction": False}
        file.write_text(json.dumps({"format": 2, "acquire": {"scan": scan}, "reconstruct": {"focus": focus}}))
        return ["--recipe", str(file)]

    def suggest(self, folder):
        """The settings that fvdctl suggests for a folder; None if it takes no folder, or refuses this one."""
        run = subprocess.run([self.fvdctl, "suggest", str(folder)], capture_output=True, text=True)
        found = re.search(r'"focus": (\{.*?\})', run.stdout)
        return json.loads(found.group(1)) if run.returncode == 0 and found else None

    def process(self, folder, options=(), may_lose=False):
        """options: a dictionary of option to value. may_lose: slices may be left out, if the program can do that."""
        self.runs += 1
        out = self.work / f"result_{self.runs}"
        command = [self.fvdctl, "process", str(folder), "--z-file", str(pathlib.Path(folder) / "z.txt"), "--out", str(out)]
        if may_lose and "--recipe" in self.options:
            command += self.lost_allowed
        for option, value in dict(options).items():
            if option in self.options:
                command += [option, str(value)]
        run = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=300)
        # Progress ends each line with a carriage return or a line feed.
        errors = [line for line in re.split(r"[\r\n]+", run.stderr) if line and not re.fullmatch(r"slice \d+/\d+", line)]
        return Result(out, run.returncode, "\n".join(errors))


class Result:
    """Heights in um, NaN where there is a hole; nothing but a message if the program refused."""

    def __init__(self, out, status, message):
        self.status = status
        self.message = message
        self.record = {}
        self.height = self.sigma = self.smooth = None
        if status != 0:
            return
        self.record = json.loads((out / "result.json").read_text())
        self.height = read_um(out / "height.tiff")
        self.sigma = read_um(out / "sigma.tiff")
        if (out / "height_smooth.tiff").exists():
            self.smooth = read_um(out / "height_smooth.tiff")

    @property
    def suspects(self):
        """Indices of the slices that the program does not believe, in its result or in its refusal."""
        if self.status == 0:
            return {entry["index"] for entry in self.record.get("slices", {}).get("suspect", [])}
        named = re.findall(r"slice_0*(\d+)\.", self.message) or re.findall(r"slice (\d+)", self.message)
        return {int(index) for index in named}


def read_um(file):
    image = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
    if image is None:
        raise SystemExit(f"{file} is no image")
    return image.astype(np.float64) * 1e6


class Errors:
    """Heights against the truth over `where`; all points of it that are kept count."""

    def __init__(self, result, truth, where=None):
        self.where = np.isfinite(truth) if where is None else where & np.isfinite(truth)
        height = np.full(truth.shape, np.nan) if result.height is None else result.height
        self.kept_points = self.where & np.isfinite(height)
        self.error = (height - truth)[self.kept_points]
        self.sigma = None if result.sigma is None else result.sigma[self.kept_points]

    @property
    def kept(self):
        return float(self.kept_points.sum() / self.where.sum())

    @property
    def rms(self):
        return float(np.sqrt(np.mean(self.error**2))) if self.error.size else None

    def wrong(self, limit_um):
        """Share of the kept points that are off by more."""
        return float(np.mean(np.abs(self.error) > limit_um)) if self.error.size else 0.0

    @property
    def sigma_ratio(self):
        """Predicted over observed RMS."""
        return float(np.sqrt(np.mean(self.sigma**2) / np.mean(self.error**2))) if self.error.size else None
