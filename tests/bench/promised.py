#!/usr/bin/env python3
"""Whether the figures of a benchmark are within what the documents promise.

promised.py FILE 'KEY<=BOUND' 'KEY==VALUE' ...
FILE holds the benchmark's output, its last line one JSON object. Names each broken promise on standard error.
"""
import json
import operator
import re
import sys

COMPARE = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        figures = json.loads(file.read().rstrip("\n").rsplit("\n", 1)[-1])
    broken = 0
    for promise in sys.argv[2:]:
        match = re.fullmatch(r"(\w+)(<=|>=|==)([\d.]+)", promise)
        if not match or match[1] not in figures:
            sys.exit(f"promised.py: {promise}: KEY<=BOUND with a key of the figures expected")
        if not COMPARE[match[2]](figures[match[1]], float(match[3])):
            broken += 1
            print(f"promise broken: {promise}, measured {figures[match[1]]}", file=sys.stderr)
    sys.exit(1 if broken else 0)


main()
