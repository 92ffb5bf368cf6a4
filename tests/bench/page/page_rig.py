"""A station with its HTTP port and tokens, for what is measured of it without a browser: the rig of ../service."""

import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))
from rig import Rig, wait_for  # noqa: E402  # pylint: disable=wrong-import-position

ROLES = ("view", "operate", "set_up", "administer")


class PageRig(Rig):
    """`tokens` by role, `http_port` once started; it stays the same over restarts."""

    def __init__(self, build, recipes=None, simulation=()):
        super().__init__(build, recipes, simulation=simulation)
        try:
            self.http_port = 0
            self.tokens = {role: self.new_token(role) for role in ROLES}
            self.settings |= {"http.port": 0, "rpc.token_file": str(self.folder / "tokens")}
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise

    def new_token(self, role):
        made = self.fvdctl("token", "new", f"page-{role}", role)
        if made.returncode != 0:
            sys.exit(f"fvdctl token new: {made.stderr}")
        token, line = made.stdout.split("\n")[:2]
        file = os.open(self.folder / "tokens", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        with open(file, "w", encoding="ascii") as tokens:
            tokens.write(line + "\n")
        return token

    def log(self):
        return (self.folder / "fvd.log").read_text(encoding="utf-8", errors="replace")

    def start(self):
        client = super().start()
        if self.http_port == 0:
            found = wait_for(lambda: re.findall(r"HTTP on 127\.0\.0\.1:(\d+)", self.log()), what="the HTTP port")
            self.http_port = self.settings["http.port"] = int(found[-1])
        return client

    @property
    def database(self):
        return self.state / "fvd.sqlite"
