"""Judges what fvdctl makes of the scenes of bench_truth and of the stacks with truth. Called by run_truth.sh.

Usage: truth_figures.py SCENES FVDCTL DATA [OTHERS..]. The last line is one JSON object; a figure that cannot be measured is null.
OTHERS: files whose last line is a JSON object with figures of other benchmarks.
"""

import json
import pathlib
import sys
import tempfile

import cv2
import numpy as np

from truth_process import Errors, Program

STEP_UM = 10.0
BORDER_PX = 8
# Every test that makes holes, off; what a program does not know is left out.
UNMASKED = {"--min-prominence": 0, "--min-significance": 0, "--broad-curve": 0, "--narrow-curve": 0, "--max-sigma": 0}
SMOOTH = {"--window": 5, "--smooth": 4.4}
# Stack, slices for a unit of its truth, truth at its first slice.
REFERENCES = {"cou1": (1.0, 0.0), "cou6": (1.0, 0.0), "cone31": (1 / 0.002, 0.09 / 0.002)}
SUSPECT_KINDS = ("dark", "half", "constant", "repeated", "exchanged", "vibrated")
# Figures of the other benchmarks; the larger where both measure one.
ELSEWHERE = (
    "live_dark_step_um",
    "retaken",
    "auto_bin_over_best",
    "names_right",
    "silently_dropped",
    "cases_right",
    "default_over_opencv",
    "sml9_over_opencv",
    "finish_over_slice",
    "state_bytes_mono8",
    "state_bytes_mono8_second_peak",
    "process_over_python_raw",
    "process_over_python_png",
    "process_over_python_jpeg",
    "process_raw_over_cat_memcpy",
)


def say(*words):
    print(*words, flush=True)


def over(value, reference):
    return None if value is None or not reference else value / reference


class Judge:
    def __init__(self, scenes, program, data):
        self.scenes = scenes
        self.program = program
        self.data = data
        self.figures = json.loads((scenes / "figures.json").read_text())
        self.false_suspects = 0
        self.ratios = {}

    def truth(self, scene):
        return cv2.imread(str(self.scenes / scene / "truth/truth.tiff"), cv2.IMREAD_UNCHANGED).astype(np.float64)

    def regions(self, scene):
        return cv2.imread(str(self.scenes / scene / "truth/regions.png"), cv2.IMREAD_UNCHANGED)

    def inside(self, shape, border=BORDER_PX):
        inside = np.zeros(shape, bool)
        inside[border:-border, border:-border] = True
        return inside

    def clean(self, scene, options=()):
        """A stack in which no slice is suspect."""
        result = self.program.process(self.scenes / scene, options)
        self.count_false(scene, result)
        return result

    def count_false(self, scene, result):
        self.false_suspects += len(result.suspects)
        if result.suspects:
            say(f"{scene}: slices {sorted(result.suspects)} are suspected wrongly")
        if result.status != 0:
            say(f"{scene}: {result.message}")

    def layered(self):
        """A side without texture can only be wrong: there the share is of all its points, not of the kept."""
        say("Layered, near plane and far plane: share wrong 0 to 9 px from the edge, and kept; the same 9 to 60 px")
        near_wrong, far_wrong, near_kept, far_kept = [], [], [], []
        for name in ("bright_over_dark", "dark_over_bright", "bright_over_black", "equal"):
            truth = self.truth("layered_" + name)
            result = self.clean("layered_" + name)
            middle = (truth.max() + truth.min()) / 2
            inside = self.inside(truth.shape, 60)
            strips = {9: [], 60: []}
            for side in (truth > middle, truth < middle):
                distance = cv2.distanceTransform(side.astype(np.uint8), cv2.DIST_L2, 5) - 0.5
                strips[9].append(Errors(result, truth, inside & side & (distance < 9)))
                strips[60].append(Errors(result, truth, inside & side & (distance > 9) & (distance < 60)))
            plain = [False, name == "bright_over_black"]
            wrong = [e.wrong(STEP_UM) * (e.kept if poor else 1) for e, poor in zip(strips[9], plain)]
            near_wrong.append(max(wrong))
            far_wrong.append(
                sum(e.wrong(STEP_UM) * e.error.size for e in strips[60]) / max(1, sum(e.error.size for e in strips[60]))
            )
            near_kept += [e.kept for e, poor in zip(strips[9], plain) if not poor]
            far_kept += [e.kept for e, poor in zip(strips[60], plain) if not poor]
            say(
                f"  {name:18} {wrong[0]:.3f} {strips[9][0].kept:.3f}  {wrong[1]:.3f} {strips[9][1].kept:.3f}"
                + "".join(f"   {e.wrong(STEP_UM):.4f} {e.kept:.4f}" for e in strips[60])
            )
        self.figures["layered_wrong_near"] = max(near_wrong)
        self.figures["layered_wrong_far"] = max(far_wrong)
        self.figures["layered_kept_near"] = min(near_kept)
        self.figures["layered_kept_far"] = min(far_kept)

    def textureless(self):
        say("Textureless half with a dark slice, blinking pixels, a half slice: kept there, and of the textured half")
        truth = self.truth("textureless_clean")
        columns = np.arange(truth.shape[1])[None, :]
        inside = self.inside(truth.shape, 12)
        # The neighbour's blur reaches so far: 10 px wide at 140 um.
        plain, textured = inside & (columns > 240 + 48), inside & (columns < 240 - 12)
        for name in ("clean", "dark", "blink", "partial"):
            scene = "textureless_" + name
            result = self.clean(scene) if name == "clean" else self.program.process(self.scenes / scene, may_lose=True)
            kept = [Errors(result, truth, where).kept for where in (plain, textured)]
            say(f"  {name:8} {kept[0]:.5f}  {kept[1]:.4f}  {result.message}")
            if name != "clean":
                self.figures["textureless_valid_" + name] = kept[0]
                self.figures["textured_valid_" + name] = kept[1]

    def glints(self):
        say("Glints of so many times full scale: kept, RMS um, share wrong of the kept")
        for times in (0, 10, 40, 200):
            scene = f"glint{times}"
            truth = self.truth(scene)
            errors = Errors(self.clean(scene), truth, self.inside(truth.shape))
            say(f"  {times:4} {errors.kept:.4f}  {errors.rms or 0:.3f}  {errors.wrong(8.0):.5f}")
            if times == 0:
                continue
            self.figures[scene + "_kept"] = errors.kept
            if times == 10:
                self.figures["glint10_rms_um"] = errors.rms
            if times == 200:
                self.figures["glint200_wrong"] = errors.wrong(8.0)

    def disturbed(self):
        say("Disturbed slices: RMS um, kept, over the clean stack")
        truth = self.truth("clean")
        inside = self.inside(truth.shape, 12)
        clean = Errors(self.clean("clean"), truth, inside)
        self.ratios["tilted plane"] = clean.sigma_ratio
        say(f"  clean      {clean.rms:.3f} {clean.kept:.4f}")
        for scene in ("flicker10", "vibration", "repeated", "drift"):
            options = {"--drift": "auto"} if scene == "drift" else {}
            result = self.program.process(self.scenes / scene, options, may_lose=True)
            errors = Errors(result, truth, inside)
            say(f"  {scene:10} {errors.rms or 0:.3f} {errors.kept:.4f}  {result.message}")
            if scene == "drift":
                self.figures["drift_rms_over_clean"] = over(errors.rms, clean.rms)
                continue
            self.figures[scene + "_over_clean"] = over(errors.rms, clean.rms)
            self.figures[scene + "_kept"] = errors.kept / clean.kept

    def suspects(self):
        say("Slices that must not be believed: found of ten stacks each, kinds of which one was missed")
        found = {kind: 0 for kind in SUSPECT_KINDS}
        for folder in sorted(self.scenes.glob("suspect_*")):
            parts = folder.name.split("_")
            if parts[2] == "clean":
                self.clean(folder.name)
                continue
            kind, index = parts[2], int(parts[3])
            # Either of two slices that are alike or that have changed places will do.
            planted = {"repeated": {index - 1, index}, "exchanged": {index, index + 1}}.get(kind, {index})
            hit = bool(planted & self.program.process(folder, may_lose=True).suspects)
            found[kind] += hit
            if not hit:
                say(f"  {folder.name}: not found")
        say(" ", ", ".join(f"{kind} {count}" for kind, count in found.items()))
        self.figures["suspect_found"] = sum(found.values())

    def chapters(self):
        say("Chapter's surface: RMS um on plateaus and ramp, predicted over observed")
        sml9 = {"--operator": "modified_laplacian", "--window-shape": "box", "--window": 9, "--distance": 1, "--peak": "parabola"}
        for scene in ("chapter", "chapter_white", "chapter_fine", "chapter_pale"):
            truth, regions = self.truth(scene), self.regions(scene)
            result = self.clean(scene)
            plateaus = Errors(result, truth, (regions >= 1) & (regions <= 3))
            ramp = Errors(result, truth, regions == 4)
            textured = Errors(result, truth, (regions >= 1) & (regions <= 4))
            self.ratios[scene] = textured.sigma_ratio
            say(f"  {scene:14} {plateaus.rms:.3f} {ramp.rms:.3f}  {textured.sigma_ratio:.2f}")
            if scene != "chapter":
                continue
            self.figures["chapter_plateau_rms_um"] = plateaus.rms
            self.figures["chapter_ramp_rms_um"] = ramp.rms
            own = Errors(self.program.process(self.scenes / scene, sml9), truth, (regions >= 1) & (regions <= 3))
            self.figures["chapter_sml9_plateau_rms_um"] = own.rms

    def bins(self):
        """A recorded stack of a fine step. live() has the place for the second live scan of such a step."""
        truth, regions = self.truth("fine_step"), self.regions("fine_step")
        textured = (regions >= 1) & (regions <= 4)

        def rms(options):
            return Errors(self.program.process(self.scenes / "fine_step", options), truth, textured).rms

        best = min(rms({"--bin": count}) for count in (1, 2, 3, 4, 5, 6))
        own = Errors(self.clean("fine_step"), truth, textured).rms
        say(f"Step of 0.1 widths: RMS {own:.3f} um, with the best bins {best:.3f} um")
        self.figures["auto_bin_over_best"] = over(own, best)

    def reference(self, name, work):
        """Truth in slices, and the folder of an 8-bit stack whose z counts slices."""
        source = self.data / f"generated-{name}"
        slices_per_truth, first_slice = REFERENCES[name]
        truth = cv2.imread(str(source / "truth.tiff"), cv2.IMREAD_UNCHANGED).astype(np.float64)
        folder = work / name
        folder.mkdir()
        files = sorted(file for file in source.iterdir() if file.suffix in (".png", ".jpg", ".tif", ".pgm") and file.stem[-1].isdigit())
        for k, file in enumerate(files):
            image = cv2.imread(str(file), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_GRAYSCALE)
            image = (image >> 8).astype(np.uint8) if image.dtype == np.uint16 else image
            cv2.imwrite(str(folder / f"slice_{k:03d}.pgm"), image)
        (folder / "z.txt").write_text("".join(f"{k}\n" for k in range(len(files))))
        return truth * slices_per_truth - first_slice, folder

    def references(self):
        say("Stacks with truth, slices: RMS unmasked, smoothed, predicted over observed, the same by quarters of slope")
        quarters = []
        periods = []
        with tempfile.TemporaryDirectory() as folder:
            for name in REFERENCES:
                if not (self.data / f"generated-{name}").exists():
                    say(f"  {self.data}/generated-{name} is not there: left out")
                    self.figures[name + "_rms"] = self.figures["smooth_" + name] = None
                    continue
                truth, stack = self.reference(name, pathlib.Path(folder))
                unmasked = Errors(self.program.process(stack, UNMASKED), truth)
                self.figures[name + "_rms"] = unmasked.rms
                smooth = self.program.process(stack, {**UNMASKED, **SMOOTH})
                self.figures["smooth_" + name] = None
                if smooth.smooth is not None:
                    error = (smooth.smooth - truth)[np.isfinite(smooth.smooth) & np.isfinite(truth)]
                    self.figures["smooth_" + name] = float(np.sqrt(np.mean(error**2)))
                    periods.append(smooth.record["focus"].get("smooth_lateral_period_px"))
                masked = self.program.process(stack)
                self.count_false(name, masked)
                self.ratios[name] = Errors(masked, truth).sigma_ratio
                slope = np.hypot(*np.gradient(truth))
                limits = np.nanquantile(slope, (0.0, 0.25, 0.5, 0.75, 1.0))
                by_slope = [Errors(masked, truth, (slope >= a) & (slope <= b)).sigma_ratio for a, b in zip(limits, limits[1:])]
                quarters += by_slope
                say(
                    f"  {name:7} {unmasked.rms:.4f} {self.figures['smooth_' + name] or 0:.4f}  {self.ratios[name]:.2f}  "
                    + " ".join(f"{ratio:.2f}" for ratio in by_slope)
                )
        say(f"  lateral period with smoothing, as the results say: {periods} px")
        self.figures["sigma_slope_quarter_min"] = min(quarters, default=None)
        self.figures["sigma_slope_quarter_max"] = max(quarters, default=None)

    def recorded(self):
        """A real stack without truth: only that none of its slices is suspected."""
        folder = self.data / "real-usb15"
        if not folder.exists():
            return
        with tempfile.TemporaryDirectory() as work:
            work = pathlib.Path(work)
            files = sorted(file for file in folder.iterdir() if file.suffix.lower() in (".png", ".jpg", ".jpeg", ".tif", ".pgm"))
            for k, file in enumerate(files):
                (work / f"slice_{k:03d}{file.suffix}").symlink_to(file.resolve())
            (work / "z.txt").write_text("".join(f"{k}\n" for k in range(len(files))))
            self.count_false("real-usb15", self.program.process(work))

    def suggested(self, name, folder, truth, where=None):
        """RMS with the suggested settings over that with the defaults."""
        settings = self.program.suggest(folder)
        if settings is None:
            return
        options = {"--distance": settings["distance_px"], "--window": settings["window_px"]}
        ratio = over(*(Errors(self.program.process(folder, chosen), truth, where).rms for chosen in (options, {})))
        say(f"  {name:12} {settings}  {ratio:.3f}")
        self.figures["suggest_worst_over_default"] = max(ratio, self.figures.get("suggest_worst_over_default", 0.0))

    def suggestions(self):
        say("Suggested settings: RMS over that of the defaults")
        for scene in ("chapter", "chapter_pale"):
            regions = self.regions(scene)
            self.suggested(scene, self.scenes / scene, self.truth(scene), (regions >= 1) & (regions <= 4))
        with tempfile.TemporaryDirectory() as folder:
            for name in REFERENCES:
                if (self.data / f"generated-{name}").exists():
                    truth, stack = self.reference(name, pathlib.Path(folder))
                    self.suggested(name, stack, truth)

    def elsewhere(self, files):
        for file in files:
            lines = pathlib.Path(file).read_text().strip().splitlines()
            for key, value in json.loads(lines[-1] if lines else "{}").items():
                known = self.figures.get(key)
                self.figures[key] = value if known is None else max(known, value)
        for key in ELSEWHERE:
            self.figures.setdefault(key, None)

    def run(self, others):
        self.references()
        self.chapters()
        self.layered()
        self.textureless()
        self.glints()
        self.disturbed()
        self.bins()
        self.recorded()
        self.suspects()
        self.figures["suspect_false"] = self.false_suspects
        say("Predicted over observed:", ", ".join(f"{name} {ratio:.2f}" for name, ratio in self.ratios.items()))
        self.figures["sigma_ratio_min"] = min(self.ratios.values())
        self.figures["sigma_ratio_max"] = max(self.ratios.values())
        self.suggestions()
        self.elsewhere(others)
        return {key: round(value, 4) if isinstance(value, float) else value for key, value in self.figures.items()}


def main():
    with tempfile.TemporaryDirectory() as work:
        judge = Judge(pathlib.Path(sys.argv[1]), Program(sys.argv[2], work), pathlib.Path(sys.argv[3]))
        figures = judge.run(sys.argv[4:])
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
