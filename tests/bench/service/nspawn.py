#!/usr/bin/env python3
"""Reads what tests/systemd/run.sh says and prints, last, what of the package's life in a machine holds."""
import json
import sys

WANTED = ("installed", "ready", "killed_and_back", "upgraded", "broken_file_stops", "purged")
last = ""
for line in sys.stdin:
    print(line, end="", flush=True)
    last = line if line.strip() else last
try:
    holds = json.loads(last)
except ValueError:
    sys.exit(f"nspawn.py: no figures; the package test said last: {last.strip() or 'nothing'}")
print(json.dumps({"nspawn": {name: holds.get(name, False) for name in WANTED},
                  "nspawn_missing": sum(holds.get(name) is not True for name in WANTED)}))
