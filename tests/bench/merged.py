#!/usr/bin/env python3
"""Prints the JSON objects that are the last lines of files as one. No two may have the same key.

merged.py [--sum KEY,KEY] FILE ...
--sum: of these keys, which several may have, the sum is printed.
"""
import json
import sys

names = sys.argv[1:]
summed = set()
if names[:1] == ["--sum"]:
    summed, names = set(names[1].split(",")), names[2:]
merged = {}
for name in names:
    with open(name, encoding="utf-8") as file:
        lines = file.read().rstrip("\n").rsplit("\n", 1)
    try:
        part = json.loads(lines[-1])
    except ValueError:
        sys.exit(f"merged.py: {name}: the last line is no JSON object: {lines[-1]}")
    twice = merged.keys() & part.keys()
    if twice - summed:
        sys.exit(f"merged.py: {name}: another part has these keys, too: {', '.join(sorted(twice - summed))}")
    merged.update(part | {key: merged[key] + part[key] for key in twice})
print(json.dumps(merged))
