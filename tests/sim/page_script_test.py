#!/usr/bin/env python3
"""sim/page.sh as its reader uses it: the addresses that it prints, what their tokens may, and its end.

page_script_test.py BUILD : a build of fvd, fvdctl and fvd-sim. Exits with 1 and the reason where something is wrong.
"""
import json
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import urllib.request
from urllib.parse import urlsplit

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
PATIENCE_S = 60


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def page_of(folder, world):
    """The script, beside a folder that looks like the build: what it leaves goes away with the folder. It is named as
    people name it, from where they are."""
    return subprocess.Popen(
        [os.path.join(ROOT, "sim/page.sh"), os.path.basename(folder), world, os.path.join(ROOT, "sim/plants/chapter.json")],
        cwd=os.path.dirname(folder), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))


def addresses_of(script):
    """{role: address}, once it has printed them all; and all that it said."""
    found, said = {}, ""
    for line in script.stdout:
        said += line
        if match := re.match(r"\s+(operate|set_up|view)\s.*\s(http://\S+)$", line):
            found[match[1]] = match[2]
        if "Ctrl-C" in line:
            return found, said
    sys.exit(f"FAILED: the script ended early: {said}")


def role_by(address):
    """What session.info says of the address' token."""
    parts = urlsplit(address)
    headers = {"Content-Type": "application/json"}
    if parts.fragment:
        headers["Authorization"] = "Bearer " + parts.fragment.removeprefix("token=")
    body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "session.info"}).encode()
    request = urllib.request.Request(f"{parts.scheme}://{parts.netloc}/api/jsonrpc", body, headers)
    with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
        return json.load(answer)["result"]["role"]


def still_running(folder):
    """Command lines that name the folder, from wherever."""
    folder = os.path.basename(folder)
    lines = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/cmdline", encoding="utf-8", errors="replace") as file:
                lines.append(file.read().replace("\0", " "))
        except OSError:
            pass  # it ended meanwhile
    return [line for line in lines if folder in line and "page_script_test" not in line]


def shows_the_page_until_interrupted(folder):
    script = page_of(folder, os.path.join(ROOT, "sim/worlds/groove_50.json"))
    try:
        addresses, said = addresses_of(script)
        expect(sorted(addresses) == ["operate", "set_up", "view"], f"it does not print three addresses: {said}")
        expect(len({urlsplit(each).netloc for each in addresses.values()}) == 1, "the addresses are not of one page")
        with urllib.request.urlopen(addresses["view"], timeout=PATIENCE_S) as page:
            expect("text/html" in page.headers["Content-Type"], "the address shows no page")
        for role, address in addresses.items():
            expect(role_by(address) == role, f"{address} is not of the role {role}")
        (run,) = os.listdir(os.path.join(folder, "demo"))
        mode = stat.S_IMODE(os.stat(os.path.join(folder, "demo", run, "tokens")).st_mode)
        expect(mode == 0o600, f"others may read the tokens: {mode:o}")
    finally:
        script.send_signal(signal.SIGINT)
        script.communicate(timeout=PATIENCE_S)
    expect(script.returncode == 0, f"Ctrl-C ends it with status {script.returncode}")
    expect(not still_running(folder), f"it left behind: {still_running(folder)}")
    port = urlsplit(addresses["view"]).port
    with socket.socket() as line:
        expect(line.connect_ex(("127.0.0.1", port)) != 0, "the port is still open")


def says_why_it_does_not_start(folder):
    script = page_of(folder, os.path.join(folder, "no_such_world.json"))
    said, _ = script.communicate(timeout=PATIENCE_S)
    expect(script.returncode == 70 and "fvd-sim did not start" in said and "no_such_world" in said,
           f"status {script.returncode}: {said}")
    expect(not still_running(folder), f"it left behind: {still_running(folder)}")


def main():
    for test in (shows_the_page_until_interrupted, says_why_it_does_not_start):
        with tempfile.TemporaryDirectory(prefix="fvd-page-test-") as folder:
            for part in ("daemon", "sim"):
                os.symlink(os.path.join(sys.argv[1], part), os.path.join(folder, part))
            test(folder)
    print("passed")


main()
