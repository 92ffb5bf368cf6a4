"""The figures of run_metrology.sh. usage: metrology_figures.py WORK BUILD ROOT"""

import json
import pathlib
import subprocess
import sys
import time

import numpy as np

from metrology_artefacts import Plant, box_mean, gsf, value, write_gsf
from metrology_edges import edge_plan, edges, truth_of
from metrology_eyes import others_eyes
from metrology_recorded import recorded

GROOVE = {"measurements": {"step": {"kind": "step_height", "band_from_to_um": [20, 340], "edges_um": [195, 285]}}}
STEP_RUNS = 40


def steps(plant):
    """Bias of grooves, and how often U covers the truth."""
    figures, covered = {}, 0
    for depth in (10, 50, 100):
        errors = []
        for evaluation in plant.many(lambda seed: plant.evaluated(f"groove_{depth}", GROOVE, seed), range(1, STEP_RUNS + 1)):
            height, expanded = value(evaluation, "step", "height_um")
            errors.append(height - depth)
            if depth == 50:
                covered += abs(height - depth) <= expanded
        figures[f"step{depth}_bias_um"] = round(float(np.mean(errors)), 4)
        figures[f"step{depth}_sd_um"] = round(float(np.std(errors, ddof=1)), 4)
    figures[f"step_coverage_of_{STEP_RUNS}"] = int(covered)
    return figures


def textures(plant):
    """Rough worlds against their box-averaged truth, and what a flat one says of itself."""
    plan = {"surfaces": {"level": {"steps": [{"op": "level"}]}},
            "regions": {"middle": {"rectangle_um": {"x": 20, "y": 20, "width": 440, "height": 320}}},
            "measurements": {"t": {"kind": "areal", "surface": "level", "region": "middle", "parameters": ["Sq"]}}}
    figures, worst = {}, 0.0
    for sq in (0.5, 2, 5):
        evaluation, _, slices = plant.measured("rough", plan, changes={"sq_um": sq})
        found, _ = value(evaluation, "t", "Sq_um")
        noise = evaluation["measurements"]["t"]["details"]["noise_floor_Sq_um"]
        truth = box_mean(gsf(slices / "truth/truth.gsf"), 9)[16:-16, 16:-16]
        rows, columns = np.mgrid[:truth.shape[0], :truth.shape[1]]
        design = np.stack([np.ones(truth.size), rows.ravel(), columns.ravel()], 1)
        rest = truth.ravel() - design @ np.linalg.lstsq(design, truth.ravel(), rcond=None)[0]
        error = float(found**2 / (np.mean(rest**2) + noise**2) - 1)
        figures[f"sq_rough_explained_{str(sq).replace('.', '_')}um"] = round(error, 4)
        worst = max(worst, error, key=abs)
    figures["sq_rough_explained"] = round(abs(worst), 4)
    evaluation, _, _ = plant.measured("flat", plan)
    codes = [warning["code"] for warning in evaluation["measurements"]["t"]["warnings"]]
    figures["flat_below_noise"] = "below_noise" in codes
    return figures


def sphere(plant):
    evaluation, _, slices = plant.measured("sphere", {
        "regions": {"cap": {"circle_um": {"x": 240, "y": 180, "radius": 100}}},
        "surfaces": {"form": {"steps": [{"op": "form", "form": "sphere", "regions": ["cap"]}]}},
        "measurements": {"t": {"kind": "areal", "surface": "form", "region": "cap", "parameters": ["Sq"]}}})
    values = evaluation["surfaces"]["form"][0]["did"]["values"]
    truth = plant.truth(slices)["sphere"]["radius_um"]
    return {"sphere_radius_error": round(abs(values["radius_um"]["value"] / truth - 1), 5)}


def times(plant):
    """5 Mpx: all areal parameters, and a robust second-order filter of 1 Mpx."""
    def surface(width, height):
        rows, columns = np.mgrid[:height, :width]
        z = np.sin(columns / 7.0) * np.cos(rows / 11.0) + 0.01 * columns
        return write_gsf(plant.work / f"big_{width}.gsf", z + 0.1 * np.random.default_rng(1).standard_normal(z.shape))

    def timed(file, evaluation):
        start = time.monotonic()
        plant.of_file(file, evaluation)
        return round(time.monotonic() - start, 2)

    every = ["Sa", "Sq", "Ssk", "Sku", "Sp", "Sv", "Sz", "Sdq", "Sdr", "Sal", "Str", "Std", "Smc", "Sxp", "Sk", "Spk", "Svk",
             "Smr1", "Smr2", "Vmp", "Vmc", "Vvc", "Vvv"]
    level = {"level": {"steps": [{"op": "level"}]}}
    large = surface(2448, 2048)
    figures = {"params_5mpx_s": timed(large, {"surfaces": level, "measurements": {
        "t": {"kind": "areal", "surface": "level", "parameters": every}}})}
    robust = {"r": {"steps": [{"op": "filter", "side": "L", "nesting_um": 100, "method": "gaussian_regression_2", "robust": True}]}}
    figures["robust_1mpx_s"] = timed(surface(1024, 1024), {"surfaces": robust, "measurements": {
        "t": {"kind": "areal", "surface": "r", "parameters": ["Sq"]}}})
    plan = edge_plan(truth_of(plant, "edge_r10"), 16)  # 30 sections of 480 um
    figures["edge_s"] = round(evaluate_ms(plant, "edge_r10", plan) / 1000, 3)
    # What a recipe's evaluation adds to the reference scene's result.
    figures["evaluation_delay_ms"] = round(evaluate_ms(plant, "chapter", {
        "surfaces": {"level": {"steps": [{"op": "outliers"}]}},
        "regions": {"a": {"rectangle_um": {"x": 20, "y": 20, "width": 80, "height": 300}},
                    "b": {"rectangle_um": {"x": 130, "y": 20, "width": 90, "height": 60}}},
        "measurements": {"step": {"kind": "step_between", "surface": "level", "lower": "a", "upper": "b", "slope": "from_lower"},
                         "land": {"kind": "areal", "surface": "level", "region": "a", "parameters": ["Sa", "Sq"]}}}), 1)
    return figures


def verdict(plant):
    """Five megapixels, three measurements: from the last frame to the row that clients see, with its split."""
    program = pathlib.Path(plant.sim).parents[1] / "tests/bench/bench_verdict"
    if not program.exists():
        return {}
    folder = plant.work / "verdict"
    folder.mkdir()
    made = subprocess.run([str(program), str(folder)], capture_output=True, text=True)
    if made.returncode != 0:
        print(made.stderr, file=sys.stderr)
        return {}
    split = json.loads(made.stdout.splitlines()[-1])
    return {"last_frame_to_verdict_ms": split.pop("last_frame_to_verdict_ms"), "last_frame_to_verdict_split": split}


def evaluate_ms(plant, world, plan):
    """The least of three."""
    return min(json.loads((plant.measured(world, plan, seed)[1] / "result.json").read_text())["times"]["evaluate_ms"]
               for seed in (1, 2, 3))


# Keys whose figure another benchmark or a command still to come gives.
NOT_MEASURED = {
    "lateral_error": "no command takes a cross grid's pitch through the whole path yet",
    "alpha_z_within_U_of_20": "no command calibrates z through the whole path yet",
    "last_frame_to_verdict_ms": "bench_verdict is not built, or failed",
    "ome_ok": "there is no OME-TIFF exporter yet",
    "export_worst_s": "an export failed",
}


def main():
    work, build, root = sys.argv[1:4]
    plant = Plant(work, build, root)
    figures = {}
    for part in (steps, edges, textures, sphere, others_eyes, times, verdict):
        start = time.monotonic()
        try:
            figures.update(part(plant))
        except Exception as error:  # a part that cannot run leaves its keys out, and says so
            print(f"{part.__name__}: {error}", file=sys.stderr)
            figures[f"{part.__name__}_failed"] = True
        print(f"{part.__name__}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    figures.update(recorded(build))
    figures["why"] = {key: why for key, why in {**NOT_MEASURED, **figures.pop("why", {})}.items() if figures.setdefault(key, None) is None}
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
