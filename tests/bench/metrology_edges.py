"""Edges of known rounding, notches and polished parts; for metrology_figures.py."""

import threading

import numpy as np

from metrology_artefacts import box_mean, gsf, write_gsf

CLEAN_EDGES = 60
# A notch is at its place if its deepest point is this near.
NEAR_UM = 15


def edge_plan(truth, sections_every_um=15):
    return {"measurements": {"edge": {"kind": "cutting_edge", "rake_side": truth["rake_side"], "flank_um": [40, 80],
                                      "sections_every_um": sections_every_um, "min_valid_fraction": 0.3,
                                      "chipping": {"min_depth_um": 1.5, "min_width_um": 5}}}}


ONE_LOOK = threading.Lock()


def truth_of(plant, name):
    folder = plant.work / f"look_{name}"
    with ONE_LOOK:
        if not folder.exists():
            folder.mkdir()
            plant.run(plant.sim, "truth", "--world", plant.world(name), folder)
        return plant.truth(folder)["edge"]


def edge(plant, name, seed=1, window=None):
    truth = truth_of(plant, name)
    return plant.evaluated(name, edge_plan(truth), seed, window)["measurements"]["edge"], truth


def number(made, key):
    return made["values"].get(key, {}).get("value")


def worst(errors, digits=4):
    return None if not errors or None in errors else round(max(errors), digits)


def behind_the_window(plant, name, side):
    """(the measurement, the same of the truth averaged over the window, the truth's figures)"""
    plan = edge_plan(truth_of(plant, name))
    evaluation, _, slices = plant.measured(name, plan)
    averaged = write_gsf(plant.work / f"averaged_{name}.gsf", box_mean(gsf(slices / "truth/truth.gsf"), side))
    return evaluation["measurements"]["edge"], plant.of_file(averaged, plan)["measurements"]["edge"], truth_of(plant, name)


def radii(plant):
    figures, betas = {}, []
    names = {"r25": ["edge_r25"], "r10": ["edge_r10", "edge_17deg", "edge_90deg"], "r5": ["edge_r5"]}
    for key, worlds in names.items():
        errors = []
        for made, truth in plant.many(lambda name: edge(plant, name), worlds):
            radius, beta = number(made, "radius_um"), number(made, "beta_deg")
            errors.append(abs(radius / truth["radius_um"] - 1) if radius is not None else None)
            betas.append(abs(beta - truth["beta_deg"]) if beta is not None else None)
        figures[f"edge_radius_worst_{key}"] = worst(errors)
    made = plant.many(lambda seed: edge(plant, "edge_r5", seed, {"window": "box", "window_px": 5})[0], range(1, 11))
    found = [number(one, "radius_um") for one in made]
    figures["edge_radius_worst_r5_window5"] = None if found[0] is None else round(abs(found[0] / 5 - 1), 4)
    if None not in found:
        figures["edge_radius_r5_window5_mean_of_10"] = round(float(np.mean(found)) / 5 - 1, 4)
        figures["edge_radius_r5_window5_sd"] = round(float(np.std(found, ddof=1)) / 5, 4)
    made, _ = edge(plant, "edge_sharp")
    figures["edge_sharp_radius_um"] = number(made, "radius_um")
    k_errors = []
    for made, truth in plant.many(lambda name: edge(plant, name), ("edge_k05", "edge_k2", "edge_r25")):
        k, beta = number(made, "K"), number(made, "beta_deg")
        k_errors.append(None if k is None else abs(k / truth["K"] - 1))
        betas.append(abs(beta - truth["beta_deg"]) if beta is not None else None)
    figures["k_worst"] = worst(k_errors)
    figures["beta_worst_deg"] = worst(betas, 3)
    apparent = []
    for name in ("edge_r25", "edge_r10", "edge_r5"):
        made, averaged, _ = behind_the_window(plant, name, 9)
        apparent.append(abs(number(made, "radius_apparent_um") / number(averaged, "radius_apparent_um") - 1))
    figures["edge_apparent_explained"] = worst(apparent)
    return figures


def notches(plant):
    made, averaged, truth = behind_the_window(plant, "edge_notched", 9)
    found = made["details"]["chipping"]["notches"]
    # The averaged truth begins half a window further in.
    expected = [(notch["x_um"] + 4, notch["depth_um"]) for notch in averaged["details"]["chipping"]["notches"]]
    missed, errors, taken = 0, [], set()
    for planted in truth["notches"]:
        at = planted["at_um"][0]
        near = [index for index, notch in enumerate(found) if abs(notch["x_um"] - at) < NEAR_UM]
        taken.update(near)
        missed += not near
        behind = [depth for x, depth in expected if abs(x - at) < NEAR_UM]
        errors.append(abs(max(found[index]["depth_um"] for index in near) - max(behind)) if near and behind else None)
    clean = plant.many(lambda seed: edge(plant, "edge_r10", seed)[0], range(1, CLEAN_EDGES + 1))
    polished, truth = edge(plant, "edge_polished")
    chipping = polished["details"]["chipping"]
    planted = 120 / 480  # um of the world's contrast_map, of its width
    return {"notches_planted": len(truth_of(plant, "edge_notched")["notches"]), "notches_missed": missed,
            "notch_depth_error_um": worst(errors, 3),
            "notches_invented": len(found) - len(taken) + sum(len(one["details"]["chipping"]["notches"]) for one in clean),
            "clean_edges": CLEAN_EDGES, "polished_gullies": len(chipping["notches"]),
            "unmeasured_error": round(abs(chipping["unmeasured_um"] / chipping["length_um"] - planted), 4)}


def edges(plant):
    return {**radii(plant), **notches(plant)}
