"""What is attacked: a station with a result, beside it what must not be reached, and requests as an attacker writes them."""

import json
import os
import time

from http_calls import Http, send_raw
from rig import RECIPE, wait_for

JSON_TYPE = "Content-Type: application/json"
# At most 15 characters are what a camera's registers hold.
DEVICE_WORDS = ("--serial", "<img src=q>", "--name", "<b id=dev>x</b>")
SCRIPT_PART, FORMULA_PART = "<img src=q onerror=alert(1)>", '=HYPERLINK("http://h","x")'
SCRIPT_RECIPE = "<script>alert(1)</script><img src=q onerror=alert(1)>"


class Site:
    def __init__(self, rig):
        self.rig = rig
        self.client = rig.start()
        self.port = rig.http_port
        self.jobs = [self.measure(seq, part) for seq, part in enumerate(("part", SCRIPT_PART, FORMULA_PART), 1)]
        evil = json.dumps(RECIPE | {"description": SCRIPT_RECIPE})
        self.client.ask("recipe.save", id="evil", text=evil, base_version=0, author="attack")
        folder = rig.state / "results" / self.jobs[0]
        (folder / "beside.txt").write_text("a file that no record names")
        self.linked = "step_log.csv"
        (folder / self.linked).unlink()
        os.symlink("/etc/passwd", folder / self.linked)
        self.before = self.condition()

    def measure(self, seq, part):
        self.client.ask("job.start", seq=seq, part_id=part, recipe="part")
        ended = wait_for(lambda: self.client.ask("job.wait", seq=seq), what="a job")
        wait_for(lambda: "pending" not in json.dumps(self.result(seq)["files"]), what="the result's files")
        self.client.ask("result.ack", seq=seq)
        wait_for(lambda: self.client.ask("system.state")["ready"], what="ready")
        return ended["job_id"]

    def result(self, seq):
        return self.client.ask("result.get", seq=seq, format="complete")["result"]

    def condition(self):
        """What an attack that was refused has not changed."""
        return (self.client.ask("job.latest", client="plc")["newest_seq"], self.client.ask("control.state")["owner"],
                json.dumps(self.client.ask("recipe.list")))

    def is_untouched(self):
        return self.condition() == self.before

    # --- requests ---

    def raw(self, method, path, *fields, body=b"", host=None, token=None, **how):
        """host: "" = no such field."""
        host = f"127.0.0.1:{self.port}" if host is None else host
        lines = [f"{method} {path} HTTP/1.1", *([f"Host: {host}"] if host else []), *fields]
        if token:
            lines.append(f"Authorization: Bearer {token}")
        if body and not any(field.lower().startswith(("content-length", "transfer-encoding")) for field in fields):
            lines.append(f"Content-Length: {len(body)}")
        return send_raw(self.port, ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1") + body, **how)

    def call(self, method, params, *fields, path="/api/jsonrpc", **more):
        """A call whose type is JSON unless `fields` name another."""
        typed = fields if any(field.startswith("Content-Type") for field in fields) else (JSON_TYPE, *fields)
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode()
        return self.raw("POST", path, *typed, body=body, **more)

    def start(self, *fields, **more):
        """What moves the stage."""
        return self.call("job.start", {"seq": 900, "part_id": "attack", "recipe": "part"}, *fields, **more)

    def file(self, name, *fields):
        return self.raw("GET", f"/api/v1/jobs/{self.jobs[0]}/files/{name}", *fields)

    def map(self, *fields, job=None, query="max=64"):
        return self.raw("GET", f"/api/v1/jobs/{job or self.jobs[0]}/height?{query}", *fields)

    def known_caller(self):
        """Whether who has a token is answered, and how soon."""
        begun = time.monotonic()
        http = Http(self.port, self.rig.tokens["operate"])
        try:
            http.call("system.state")
        finally:
            http.close()
        return time.monotonic() - begun
