"""Runs the cases of recorded slices in a folder of situations, and holds what comes out against what is right.

Usage: recorded_cases.py CASES BUILD SOURCE [CASE..]. Exit status 77 where the cases, or what makes their inputs, are missing.
"""

import ast
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
TIMEOUT_S = 300
MODULES = ("numpy", "cv2", "tifffile")

GOOD = {"exit": 0, "least": {"valid": 0.99}, "most": {"rms": 0.23, "wrong": 0.0}}
HOLES = {"exit": 0, "most": {"valid": 0.001}}
# One slice is left out, or two that follow each other, which leaves a gap of three steps.
NEARLY = {"exit": 0, "least": {"valid": 0.98}, "most": {"rms": 0.26, "wrong": 0.0}}
TWO_LESS = {"exit": 0, "least": {"valid": 0.98}, "most": {"rms": 0.5, "wrong": 0.0}}


def asks(*words):
    return {"exit": 65, "says": words}


# What each line of a case has to be: its exit status, bounds of its figures, words of its message.
RIGHT = {
    "negative_z_in_names": {"all_positive": GOOD, "from_minus_20": GOOD, "from_minus_50_um": GOOD},
    "counter_rollover": {"with_step": GOOD, "with_z_list": GOOD},
    "z_list_utf16": {"utf16": GOOD, "plus_signs": GOOD},
    "one_file_per_plane_and_channel": {
        "z_then_channel": GOOD,
        "objective_at_the_end": GOOD,
        "three_channels": asks("--pattern", "ch00"),
    },
    "imagej_two_channels": {"imagej_z_c": asks("--channel"), "ome_c_z_second_channel_brighter": asks("--channel")},
    "imagej_over_4gb_layout": {"one_ifd_21_images": GOOD},
    "tiff_pages_not_slices": {
        "reduced_page_last": GOOD,
        "every_file_with_a_reduced_page": GOOD,
        "packed_12_bit": GOOD,
    },
    "twelve_bits_in_sixteen": {
        name: {"exit": 0, "least": {"valid": 0.9}, "most": {"wrong": 0.0001, "over4": 0.03, "region valid": 0.1}}
        for name in ("pgm_says_4095", "png_12_of_16")
    },
    "dark_frame_smooth_part": {
        "smooth_all_lit": HOLES,
        "smooth_first_frame_dark": HOLES,
        "smooth_frame_10_dark": HOLES,
        "smooth_frame_10_constant_128": HOLES,
        "weak_texture_all_lit": {"exit": 0, "least": {"valid": 0.99}, "most": {"wrong": 0.0, "over4": 0.001}},
        "weak_texture_frame_10_dark": {"exit": 0, "least": {"valid": 0.98}, "most": {"wrong": 0.0, "over4": 0.001}},
    },
    "blinking_pixels_smooth_part": {
        "smooth_none": HOLES,
        "smooth_once_20": HOLES,
        "smooth_once_60": HOLES,
        "smooth_often_60": {"exit": 0, "most": {"valid": 0.02}},
    },
    "light_flicker": {
        name: {"exit": 0, "least": {"valid": 0.99}, "most": {"rms": 0.22, "wrong": 0.0, "over4": 0.001}}
        for name in ("flicker_0.0", "flicker_0.02", "flicker_0.05", "flicker_0.1", "flicker_0.1_stage_correction")
    },
    "repeated_frame": {"frame_8_is_frame_7_bit_for_bit": NEARLY, "frames_9_and_10_swapped": TWO_LESS},
}
STEP_TRUTH_UM = (50.0, 50.0, 100.0)
STEP_ERROR_UM = 0.1


def figures_of(text):
    """The dictionary at the end of a line; its numbers may be nan."""
    return ast.literal_eval(re.sub(r"\bnan\b", "None", text))


def lines_of(output):
    """Name of each line -> its exit status, text and figures."""
    lines = {}
    name = None
    for line in output.splitlines():
        if head := re.match(r"(\S+): exit (-?\d+) \|(.*)", line):
            name = head.group(1)
            lines[name] = {"exit": int(head.group(2)), "text": head.group(3), "figures": {}}
        elif name and (score := re.match(r"\s+(against the truth|in the region\s*): (\{.*\})", line)):
            prefix = "region " if score.group(1).startswith("in") else ""
            lines[name]["figures"].update({prefix + key: value for key, value in figures_of(score.group(2)).items()})
    return lines


def wrongs(right, line):
    """What is wrong with one line, in words."""
    if line is None:
        return ["not run"]
    found = []
    if line["exit"] != right["exit"]:
        return [f"exit {line['exit']} instead of {right['exit']}: {line['text'].strip()}"]
    for word in right.get("says", ()):
        if word not in line["text"]:
            found.append(f"the message does not say '{word}': {line['text'].strip()}")
    for key, most in right.get("most", {}).items():
        value = line["figures"].get(key)
        if value is not None and value > most:
            found.append(f"{key} is {value}, at most {most}")
    for key, least in right.get("least", {}).items():
        value = line["figures"].get(key)
        if value is None or value < least:
            found.append(f"{key} is {value}, at least {least}")
    return found


def run(case, folder, environment):
    with tempfile.TemporaryDirectory(prefix="fvd-case-") as work:
        done = subprocess.run(
            [sys.executable, str(folder / case / "run.py")],
            env={**environment, "CASE_WORK": work},
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TIMEOUT_S,
        )
    return done.stdout + done.stderr[-2000:]


def check_live(output):
    """A frame without light in a live scan changes no step."""
    found = []
    for mode in ("none", "dark2", "dark12"):
        line = re.search(rf"^{mode}: (\w+),.*steps (\[.*?\]) um", output, re.MULTILINE)
        if not line:
            found.append(f"{mode}: not run: {output[-500:]}")
            continue
        steps = ast.literal_eval(line.group(2).replace("null", "None"))
        if line.group(1) != "completed" or any(
            step is None or abs(step - truth) > STEP_ERROR_UM for step, truth in zip(steps, STEP_TRUTH_UM)
        ):
            found.append(f"{mode}: {line.group(0)}")
    return found


def main():
    cases, build, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    wanted = sys.argv[4:] or [*RIGHT, "dark_frame_live"]
    missing = [module for module in MODULES if importlib.util.find_spec(module) is None]
    if not cases.is_dir() or missing:
        print(f"skipped: {cases} is not there" if not cases.is_dir() else f"skipped: no Python module {missing}")
        return SKIPPED
    failed = 0
    with tempfile.TemporaryDirectory(prefix="fvd-bin-") as programs:
        for program in ("daemon/fvd", "daemon/ctl/fvdctl", "sim/fvd-sim"):
            os.symlink(build / program, pathlib.Path(programs) / pathlib.Path(program).name)
        environment = {**os.environ, "FVD_SRC": str(source), "FVD_BIN": programs, "FVDCTL": f"{programs}/fvdctl"}
        for case in wanted:
            output = run(case, cases, environment)
            if case == "dark_frame_live":
                found = check_live(output)
            else:
                lines = lines_of(output)
                found = [f"{name}: {text}" for name, right in RIGHT[case].items() for text in wrongs(right, lines.get(name))]
            failed += bool(found)
            print(f"{case}: {'right' if not found else 'WRONG'}", *found, sep="\n    ", flush=True)
    print(f"cases right: {len(wanted) - failed} of {len(wanted)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
