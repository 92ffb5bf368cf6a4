#!/usr/bin/env python3
"""Forty attacks, each a row of a table with what must be answered; after each of them nothing has changed.

attacks.py BUILD
The last line is one JSON object.
"""

import json
import os
import pathlib
import subprocess
import sys

from attack_rows import ROWS
from attack_site import DEVICE_WORDS, Site
from page_rig import PageRig
from rig import wait_for


def by_requests(site):
    """How many were refused."""
    refused = 0
    for name, attack, must in ROWS:
        try:
            outcome = attack(site)
            is_refused = must(outcome) and site.is_untouched()
        except Exception as error:  # whatever it is, the row is not refused
            outcome, is_refused = repr(error), False
        refused += is_refused
        print(f"attack: {name}: {'refused' if is_refused else f'NOT REFUSED: {outcome}'}", flush=True)
    return refused


def by_the_page(site, rig):
    """The rows of attacks_page.mjs: how many there are and how many were refused. The camera is gone by then, so that
    the page tells of it by its name."""
    rig.simulator.terminate()
    rig.simulator.wait()
    wait_for(lambda: not site.client.ask("system.state")["ready"], what="the loss of the devices")
    own = {"FVD_PAGE_URL": f"http://127.0.0.1:{site.port}", "FVD_PAGE_TOKEN": rig.tokens["administer"],
           "FVD_PAGE_OPERATOR": rig.tokens["operate"], "FVD_ATTACK_JOBS": ",".join(site.jobs)}
    program = pathlib.Path(__file__).with_name("attacks_page.mjs")
    done = subprocess.run(["node", str(program)], env=os.environ | own, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"attacks_page.mjs ended with {done.returncode}")
    return json.loads(done.stdout.rstrip("\n").rsplit("\n", 1)[-1])


def main():
    with PageRig(sys.argv[1], simulation=DEVICE_WORDS) as rig:
        site = Site(rig)
        refused = by_requests(site)
        page = by_the_page(site, rig)
    rows, refused = len(ROWS) + page.pop("rows"), refused + page.pop("refused")
    print(json.dumps({f"attacks_of_{rows}": rows, "attacks_refused": refused, **page}))


main()
