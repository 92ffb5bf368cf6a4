"""Recorded stacks as people have them: how many names, layouts of pages and public cases come out right, of how many.

truth_reading.py BUILD SOURCE: runs the tests that hold these tables; the last line is one JSON object.
"""
import json
import pathlib
import re
import subprocess
import sys

BUILD, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


def output_of(command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False).stdout


def figures_of_tables():
    output = output_of([BUILD / "tests/drivers/replay/replay_test", "--gtest_filter=Families/*:PageLayouts.*"])
    families = len(re.findall(r"^\[ RUN +\] Families/", output, re.MULTILINE))
    right = len(re.findall(r"^\[ +OK \] Families/", output, re.MULTILINE))
    layouts = json.loads(next(line for line in output.splitlines() if line.startswith('{"layouts"')))
    print(f"Names: {right} of {families} families; pages: {layouts['layouts_right']} of {layouts['layouts']} layouts")
    return {
        "names": families + layouts["layouts"],
        "names_right": right + layouts["layouts_right"],
        # A family's test fails where a file is neither used nor counted as ignored.
        "silently_dropped": layouts["silently_dropped"] + families - right,
    }


def figures_of_cases():
    output = output_of(["/usr/bin/python3", "-B", SOURCE / "tests/cases/recorded_cases.py", SOURCE / "../shared/cases", BUILD, SOURCE])
    print(output, end="")
    found = re.search(r"^cases right: (\d+) of (\d+)$", output, re.MULTILINE)
    return {"cases": int(found.group(2)), "cases_right": int(found.group(1))} if found else {}


print(json.dumps({**figures_of_tables(), **figures_of_cases()}))
