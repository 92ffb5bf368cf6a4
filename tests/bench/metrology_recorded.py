"""Figures that tests record as properties or by passing; for metrology_figures.py."""

import json
import pathlib
import re
import subprocess

# Key of the figure, name of the property.
PROPERTIES = {"step_sd_ratio": "ratio_of_mean", "step_coverage_of_400": "covered_by_mean",
              "false_pass_of_2000": "false_pass_of_2000", "permutation_worst": "permutation_worst",
              "permutation_worst_of_counts": "permutation_worst_of_counts", "noise_error": "noise_error",
              "alpha_z_within_U_of_20": "alpha_z_within_U_of_20",
              "reader_peak_mib": "reader_peak_mib"}


def tests_of(report):
    """Every test of a report: suite, name, whether it passed, its properties."""
    for suite in json.loads(report.read_text())["testsuites"]:
        for test in suite["testsuite"]:
            yield suite["name"], test["name"], test.get("result") == "COMPLETED" and "failures" not in test, test


def run(program, arguments=()):
    report = program.parent / "record.json"
    subprocess.run([str(program), f"--gtest_output=json:{report}", *arguments], capture_output=True, cwd=program.parent)
    made = list(tests_of(report)) if report.exists() else []
    report.unlink(missing_ok=True)
    return made


def verdict_paths(build):
    """A system test lets a PLC's client see every verdict; it counts where its program was built."""
    program = pathlib.Path(build) / "tests/system/system_test"
    if not program.exists():
        return None
    made = run(program, ["--gtest_filter=AMeasuringMicroscope.TellsAPlcEveryVerdictInFewBytes"])
    return 4 if made and all(good for _, _, good, _ in made) else 0


def recorded(build):
    build = pathlib.Path(build)
    programs = sorted(build.glob("tests/core/metrology/*/metrology_*_test"))
    programs += [build / "tests/daemon/export/x3p_order_test", build / "tests/daemon/surface_files/surface_files_test",
                 build / "tests/daemon/study/study_test"]
    tests = [test for program in programs if program.exists() for test in run(program)]
    numbers = {}
    for _, _, _, properties in tests:
        for key, value in properties.items():
            if isinstance(value, str) and re.fullmatch(r"[-+0-9.e]+", value):
                numbers.setdefault(key, []).append(float(value))
    figures = {key: max(numbers[name]) if name in numbers else None for key, name in PROPERTIES.items()}
    references = {key: max(values) for key, values in numbers.items() if re.fullmatch(r"reference_\d\d", key)}
    statistical = {key: max(values) for key, values in numbers.items() if re.fullmatch(r"statistical_\d\d", key)}
    figures["reference_cases"] = len(references) + len(statistical)
    figures["reference_worst_relative"] = max(references.values(), default=None)
    figures["reference_worst_statistical"] = max(statistical.values(), default=None)
    figures["filter_worst_abs"] = max((max(values) for key, values in numbers.items() if key.startswith("filter_worst")), default=None)
    bad = [good for suite, _, good, _ in tests if suite.endswith("/BadFiles")]
    figures["bad_files"], figures["bad_files_refused"] = len(bad), sum(bad)
    order = [good for suite, _, good, _ in tests if suite == "X3pOrder"]
    figures["x3p_order_ok"] = all(order) if order else None
    figures["verdict_paths"] = verdict_paths(build)
    figures["why"] = {"x3p_order_ok": "x3p_order_test is not built", "verdict_paths": "system_test is not built",
                      "reader_peak_mib": "surface_files_test is not built", "noise_error": "study_test is not built",
                      "alpha_z_within_U_of_20": "study_test is not built"}
    return figures
