"""The pitch of a cross grid through fvd-sim render, fvdctl process and fvdctl calibrate lateral; for metrology_figures.py."""

import json
import shutil

PITCH_UM = 40.0
PIXEL_UM = 1.0
# 23 x 17 crossings: those of the stock world's 480 x 360 pixels are too few for a promise of 2e-4.
GRID = {"width_px": 960, "height_px": 720,
        "cross_grid": {"pitch_x_um": PITCH_UM, "pitch_y_um": PITCH_UM, "line_width_um": 14.0}}
# The process needs something to measure; the study does not look at it.
NOTHING = {"measurements": {"t": {"kind": "areal", "parameters": ["Sq"]}}}
RUNS = 3


def lateral(plant):
    """The worst relative error of both pitches, and how often their U covers the truth."""
    errors, covered = [], 0
    for seed in range(1, RUNS + 1):
        _, out, slices = plant.measured("cross_grid", NOTHING, seed, changes=GRID)
        done = plant.run(plant.fvdctl, "calibrate", "lateral", "--folder", out, "--grid-pitch-um", PITCH_UM, "--json")
        figures = {figure["name"]: figure for figure in json.loads(done.stdout)["study"]["figures"]}
        for name in ("pitch_x_um", "pitch_y_um"):
            errors.append(abs(figures[name]["value"] / PIXEL_UM - 1))
            covered += abs(figures[name]["value"] - PIXEL_UM) <= figures[name]["U"]
        shutil.rmtree(out)
        shutil.rmtree(slices)
    return {"lateral_error": round(max(errors), 7), f"lateral_covered_of_{2 * RUNS}": covered}
