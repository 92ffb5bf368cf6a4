#!/usr/bin/env python3
"""Profiles by result.profile beside `fvdctl measure` of the same result: parameters of 20 random lines across a map with
holes, and every point beside the file.

profile.py BUILD [LINES]
The last line is one JSON object.
"""

import json
import math
import random
import sys

from http_calls import Http
from made_result import PITCH_UM, make_results
from page_rig import PageRig
from rig import wait_for

WIDTH, HEIGHT = 480, 360
PARAMETERS = ("Pa_um", "Pq_um", "Pt_um", "Psk", "Pku")


def random_line(pick):
    """Ends and width of a band that lies inside of the map, in um."""
    width_um = pick.choice((0.0, 0.0, pick.uniform(0.5, 6.0)))

    def place():
        return tuple(pick.uniform(width_um, points * pitch - width_um)
                     for points, pitch in zip((WIDTH, HEIGHT), PITCH_UM))

    return place(), place(), width_um


def sampled(rows, start, end, width_um):
    """As core/metrology/profile.hpp says, written a second time: heights in um along the line, None = hole."""
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    unit = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
    pitch = [1 / math.hypot(x / PITCH_UM[0], y / PITCH_UM[1]) for x, y in (unit, (-unit[1], unit[0]))]
    count, across = math.floor(length / pitch[0] + 0.5), max(1, math.floor(width_um / pitch[1] + 0.5))

    def neighbours(position):
        if abs(position - round(position)) < 1e-9:
            return ((round(position), 1.0),)
        first = math.floor(position)
        return ((first, 1 - (position - first)), (first + 1, position - first))

    def at(x_um, y_um):
        total = 0.0
        for row, row_weight in neighbours(y_um / PITCH_UM[1] - 0.5):
            for column, weight in neighbours(x_um / PITCH_UM[0] - 0.5):
                inside = 0 <= row < HEIGHT and 0 <= column < WIDTH
                total += row_weight * weight * (1e6 * rows[row][column] if inside else math.nan)
        return total

    heights = []
    for i in range(count):
        along = (i + 0.5) * length / count
        total = 0.0
        for j in range(across):
            aside = (j + 0.5) * width_um / across - width_um / 2 if across > 1 else 0.0
            total += at(start[0] + along * unit[0] - aside * unit[1], start[1] + along * unit[1] + aside * unit[0])
        heights.append(None if math.isnan(total) else total / across)
    return heights


def longest_hole(heights):
    longest = run = 0
    for height in heights:
        run = run + 1 if height is None else 0
        longest = max(longest, run)
    return longest


def parameters_of(heights):
    """Of ISO 21920-2 against the least squares line over the whole profile."""
    points = [(i, z) for i, z in enumerate(heights) if z is not None]
    mean_x, mean_z = (math.fsum(column) / len(points) for column in zip(*points))
    slope = math.fsum((x - mean_x) * (z - mean_z) for x, z in points) / math.fsum((x - mean_x) ** 2 for x, _ in points)
    rest = [z - mean_z - slope * (x - mean_x) for x, z in points]
    mean = lambda power: math.fsum(z**power for z in rest) / len(rest)  # noqa: E731
    square = mean(2)
    return {"Pa_um": math.fsum(map(abs, rest)) / len(rest), "Pq_um": math.sqrt(square), "Pt_um": max(rest) - min(rest),
            "Psk": mean(3) / square**1.5, "Pku": mean(4) / square**2}


def with_holes(http, job_id, rows, lines):
    """Lines whose profiles have holes, none of them so long that no value is given, with what the daemon tells of them."""
    pick, chosen, worst_um = random.Random(5), [], 0.0
    while len(chosen) < lines:
        start, end, width_um = random_line(pick)
        if math.dist(start, end) < 60:
            continue
        told = http.call("result.profile", job_id=job_id, from_um={"x": start[0], "y": start[1]},
                         to_um={"x": end[0], "y": end[1]}, width_um=width_um)
        heights = told["height_um"]
        again = sampled(rows, start, end, width_um)
        if len(again) != len(heights) or any((a is None) != (b is None) for a, b in zip(heights, again)):
            sys.exit(f"the profile from {start} to {end} has its holes elsewhere than the file")
        worst_um = max([worst_um] + [abs(a - b) for a, b in zip(heights, again) if a is not None])
        if None in heights and longest_hole(heights) < 0.2 * len(heights):
            chosen.append((start, end, width_um, told))
    return chosen, worst_um


def by_program(rig, folder, lines):
    measurements = {
        f"l{i}": {"kind": "profile", "from_um": start, "to_um": end, "band_width_um": width_um, "sections": 1,
                  "nesting_um": math.dist(start, end), "min_valid_fraction": 0.0,
                  "parameters": ["Pa", "Pq", "Pt", "Psk", "Pku"]}
        for i, (start, end, width_um, _) in enumerate(lines)}
    recipe = json.loads((rig.folder / "recipes/part.json").read_text()) | {"evaluation": {"measurements": measurements}}
    (rig.folder / "lines.json").write_text(json.dumps(recipe))
    done = rig.fvdctl("measure", folder, "--recipe", rig.folder / "lines.json", "--json")
    if done.returncode != 0:
        sys.exit(f"fvdctl measure ended with {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)["measurements"]


def main():
    build = sys.argv[1]
    lines = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    with PageRig(build) as rig:
        client = rig.start()
        client.ask("job.start", seq=1, part_id="part", recipe="part")
        like = wait_for(lambda: client.ask("job.wait", seq=1), what="a job")["job_id"]
        client.close()
        rig.stop()
        (job_id,), rows = make_results(rig.state, like, WIDTH, HEIGHT)
        rig.start().close()
        http = Http(rig.http_port, rig.tokens["view"])
        chosen, points_um = with_holes(http, job_id, rows, lines)
        measured = by_program(rig, rig.state / "results" / job_id, chosen)
        http.close()
    worst = 0.0
    for i, (start, end, _, told) in enumerate(chosen):
        own, made = parameters_of(told["height_um"]), measured[f"l{i}"]
        for name in PARAMETERS:
            value = made["values"][name].get("value")
            if value is None:
                sys.exit(f"fvdctl measure gives no {name} from {start} to {end}: {made}")
            worst = max(worst, abs(own[name] - value))
        if made["points"] != sum(height is not None for height in told["height_um"]):
            sys.exit(f"fvdctl measure looks at {made['points']} points from {start} to {end}")
    print(f"profile: parameters differ by {worst:.3g} at most, points from the file by {points_um:.3g} um")
    print(json.dumps({"profile_equals_cli": worst, "profile_points_worst_um": points_um, "profile_lines": len(chosen)}))


main()
