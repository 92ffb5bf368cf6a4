"""Starts and ends viewer_load.py."""

import json
import pathlib
import subprocess
import sys


class Viewers:
    """There once this is made; `told` once it is left."""

    def __init__(self, port, readers, never=0):
        words = [sys.executable, pathlib.Path(__file__).with_name("viewer_load.py"), port, readers, never]
        self.program = subprocess.Popen([str(word) for word in words], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)
        self.told = None
        if self.program.stdout.readline() != "there\n":
            self.program.wait()
            sys.exit(f"viewer_load.py ended with {self.program.returncode}")

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        try:
            said, _ = self.program.communicate("", timeout=60)
            if kind is None and self.program.returncode != 0:
                sys.exit(f"viewer_load.py ended with {self.program.returncode}")
            if kind is None:
                self.told = json.loads(said)
        finally:
            if self.program.poll() is None:
                self.program.kill()
                self.program.wait()
