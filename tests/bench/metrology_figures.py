"""The figures of run_metrology.sh. usage: metrology_figures.py WORK BUILD ROOT"""

import json
import pathlib
import re
import subprocess
import sys
import time

import numpy as np

from metrology_artefacts import Plant, box_mean, gsf, value

GROOVE = {"measurements": {"step": {"kind": "step_height", "band_from_to_um": [20, 340], "edges_um": [195, 285]}}}
STEP_RUNS = 40


def steps(plant):
    """Bias of grooves, and how often U covers the truth."""
    figures, covered = {}, 0
    for depth in (10, 50, 100):
        errors = []
        for seed in range(1, STEP_RUNS + 1):
            evaluation, _, _ = plant.measured(f"groove_{depth}", GROOVE, seed)
            height, expanded = value(evaluation, "step", "height_um")
            errors.append(height - depth)
            if depth == 50:
                covered += abs(height - depth) <= expanded
        figures[f"step{depth}_bias_um"] = round(float(np.mean(errors)), 4)
        figures[f"step{depth}_sd_um"] = round(float(np.std(errors, ddof=1)), 4)
    figures[f"step_coverage_of_{STEP_RUNS}"] = int(covered)
    return figures


def edge_plan(truth, flank_to=80):
    return {"measurements": {"edge": {"kind": "cutting_edge", "rake_side": truth["rake_side"], "flank_um": [40, flank_to],
                                      "sections_every_um": 15, "min_valid_fraction": 0.3, "chipping": {"min_depth_um": 1.5, "min_width_um": 5}}}}


def edge(plant, name, seed=1, window=None):
    slices = plant.work / f"look_{name}"
    if not slices.exists():
        slices.mkdir()
        plant.run(plant.sim, "truth", "--world", plant.world(name), slices)
    truth = plant.truth(slices)["edge"]
    evaluation, _, _ = plant.measured(name, edge_plan(truth), seed, window)
    return evaluation["measurements"]["edge"], truth


def number(made, key):
    return made["values"].get(key, {}).get("value")


def edges(plant):
    figures = {}
    names = {"r25": ["edge_r25"], "r10": ["edge_r10", "edge_17deg", "edge_90deg"], "r5": ["edge_r5"]}
    betas = []
    for key, worlds in names.items():
        errors = []
        for name in worlds:
            made, truth = edge(plant, name)
            radius = number(made, "radius_um")
            errors.append(abs(radius / truth["radius_um"] - 1) if radius is not None else None)
            beta = number(made, "beta_deg")
            betas.append(abs(beta - truth["beta_deg"]) if beta is not None else None)
        figures[f"edge_radius_worst_{key}"] = None if None in errors else round(max(errors), 4)
    made, truth = edge(plant, "edge_r5", window={"window": "box", "window_px": 5})
    radius = number(made, "radius_um")
    figures["edge_radius_worst_r5_window5"] = None if radius is None else round(abs(radius / 5 - 1), 4)
    made, _ = edge(plant, "edge_sharp")
    figures["edge_sharp_radius_um"] = number(made, "radius_um")
    k_errors = []
    for name in ("edge_k05", "edge_k2", "edge_r25"):
        made, truth = edge(plant, name)
        k = number(made, "K")
        k_errors.append(None if k is None else abs(k / truth["K"] - 1))
    figures["k_worst"] = None if None in k_errors else round(max(k_errors), 4)
    figures["beta_worst_deg"] = None if None in betas else round(max(betas), 3)
    made, truth = edge(plant, "edge_notched")
    figures["notches_found"] = number(made, "notches")
    figures["notches_planted"] = len(truth["notches"])
    invented = 0
    for seed in range(1, 11):
        made, _ = edge(plant, "edge_r10", seed)
        invented += number(made, "notches") or 0
    figures["notches_invented_of_10"] = int(invented)
    made, _ = edge(plant, "edge_polished")
    figures["polished_gullies"] = len(made["details"]["chipping"]["notches"])
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
        worst = max(worst, abs(found**2 / (np.mean(rest**2) + noise**2) - 1), key=abs)
    figures["sq_rough_explained"] = round(float(worst), 4)
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


def others_eyes(plant):
    """Files that other programs open, and the same values from each of them."""
    evaluation, out, _ = plant.measured("letter_f", {
        "surfaces": {"level": {"steps": [{"op": "level"}]}},
        "measurements": {"t": {"kind": "areal", "surface": "level", "parameters": ["Sa", "Sq", "Sz", "Sku"]},
                         "p": {"kind": "profile", "from_um": [20, 180], "to_um": [460, 180], "parameters": ["Ra"]}}})
    recipe = plant.work / f"recipe_{plant.runs}.json"
    folder = json.loads(plant.run(plant.fvdctl, "measure", out, "--recipe", recipe, "--json").stdout)
    figures = {"online_equals_offline": folder == evaluation}
    opened, same = {}, True
    for form in ("x3p", "gsf", "sdf"):
        file = plant.work / f"f.{form}"
        start = time.monotonic()
        plant.run(plant.fvdctl, "export", out, "--format", form, "--out", file)
        figures[f"export_{form}_s"] = round(time.monotonic() - start, 2)
        again = json.loads(plant.run(plant.fvdctl, "measure", file, "--recipe", recipe, "--json").stdout)
        for name, made in evaluation["measurements"].items():
            for key, was in made["values"].items():
                same = same and was.get("value") == again["measurements"][name]["values"][key].get("value")
        gwy = plant.work / f"{form}.gwy"
        opened[form] = subprocess.run(["gwyddion", f"--convert-to-gwy={gwy}", str(file)], capture_output=True,
                                      env={"PATH": "/usr/bin:/bin", "HOME": str(plant.work)}).returncode == 0 and gwy.exists()
    figures["files_give_the_same_values"] = same
    figures["gwyddion_files"] = len(opened)
    figures["gwyddion_files_ok"] = sum(opened.values())
    stl = plant.work / "f.stl"
    plant.run(plant.fvdctl, "export", out, "--format", "stl", "--out", stl)
    text = subprocess.run(["admesh", str(stl)], capture_output=True, text=True).stdout
    degenerate = re.search(r"Degenerate facets\s*:\s*(\d+)", text)
    figures["stl_degenerate_facets"] = int(degenerate.group(1)) if degenerate else None
    return figures


def times(plant):
    """5 Mpx: all areal parameters, and a robust second-order filter of 1 Mpx."""
    def surface(width, height):
        rows, columns = np.mgrid[:height, :width]
        z = 1e-6 * (np.sin(columns / 7.0) * np.cos(rows / 11.0) + 0.01 * columns)
        z += 1e-7 * np.random.default_rng(1).standard_normal(z.shape)
        head = (f"Gwyddion Simple Field 1.0\nXRes = {width}\nYRes = {height}\nXReal = {width}e-6\nYReal = {height}e-6\n"
                "XYUnits = m\nZUnits = m\n").encode()
        file = plant.work / f"big_{width}.gsf"
        file.write_bytes(head + b"\0" * (4 - len(head) % 4) + z.astype("<f4").tobytes())
        return file

    def timed(file, evaluation):
        recipe = plant.work / "big.json"
        recipe.write_text(json.dumps({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 21}},
                                      "reconstruct": {"lateral": {"pixel_pitch_x_um": 1, "pixel_pitch_y_um": 1}},
                                      "evaluation": evaluation}))
        start = time.monotonic()
        plant.run(plant.fvdctl, "measure", file, "--recipe", recipe, "--json")
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
    return figures


# Properties of unit tests, by the names of the figures.
RECORDED = {"step_sd_ratio": "ratio_of_mean", "step_coverage_of_400": "covered_by_mean",
            "false_pass_of_2000": "false_pass_of_2000"}


def recorded(build):
    """Figures that the unit tests record as properties."""
    found = {}
    for test in sorted(pathlib.Path(build).glob("tests/core/metrology/*/metrology_*_test")):
        report = test.parent / "record.json"
        subprocess.run([str(test), f"--gtest_output=json:{report}"], capture_output=True)
        text = report.read_text()
        report.unlink()
        for key, property_name in RECORDED.items():
            match = re.search(rf'"{property_name}": "?([-0-9.e]+)', text)
            if match:
                found[key] = round(float(match.group(1)), 4)
    return {key: found.get(key) for key in RECORDED}


def main():
    work, build, root = sys.argv[1:4]
    plant = Plant(work, build, root)
    figures = {}
    for part in (steps, edges, textures, sphere, others_eyes, times):
        start = time.monotonic()
        try:
            figures.update(part(plant))
        except Exception as error:  # a part that cannot run leaves its keys out, and says so
            print(f"{part.__name__}: {error}", file=sys.stderr)
            figures[f"{part.__name__}_failed"] = True
        print(f"{part.__name__}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    figures.update(recorded(build))
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
