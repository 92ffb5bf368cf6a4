#!/usr/bin/env python3
"""Prints the JSON objects that are the last lines of files as one. No two may have the same key."""
import json
import sys

merged = {}
for name in sys.argv[1:]:
    with open(name, encoding="utf-8") as file:
        lines = file.read().rstrip("\n").rsplit("\n", 1)
    try:
        part = json.loads(lines[-1])
    except ValueError:
        sys.exit(f"merged.py: {name}: the last line is no JSON object: {lines[-1]}")
    if twice := merged.keys() & part.keys():
        sys.exit(f"merged.py: {name}: another part has these keys, too: {', '.join(sorted(twice))}")
    merged.update(part)
print(json.dumps(merged))
