#!/usr/bin/env python3
"""A backup that is made while the daemon measures, put back beside what is there, and where all is gone.

restore.py BUILD [JOBS]
Prints a line for each difference and, last, one JSON object.
"""

import hashlib
import json
import pathlib
import shutil
import sys
import time

from rig import START_TIMEOUT_S, Answer, Rig, recipe, wait_for

AFTER = 3  # jobs behind the backup, whose results are lost with it


def fetched(client, seq):
    """What must be told again, and the files that it names."""
    told = client.ask("result.get", seq=seq, format="full")
    told.pop("age_s")
    told["times"].pop("follow_ms", None)  # of files that are made later, and anew if the backup came in between
    folder = pathlib.Path(told["directory"])
    files = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(folder.iterdir())
             if file.is_file() and file.name != "result.json" and not file.name.startswith(".")}
    return told | {f"file {name}": digest for name, digest in files.items()}


def files_are_made(folder):
    """Those that no verdict waits for, too."""
    result = json.loads((pathlib.Path(folder) / "result.json").read_text())
    return all(file["state"] != "pending" for file in result["files"])


def measure(client, seq):
    client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
    if client.ask("job.wait", seq=seq)["state"] != "completed":
        sys.exit("a job does not complete")


def ctl(rig, *words):
    done = rig.fvdctl(*words, "--config", rig.folder / "fvd.json")
    if done.returncode != 0:
        sys.exit(f"fvdctl {words[0]} ended with {done.returncode}: {done.stderr}{done.stdout}: see {rig.folder}")


class Restored:
    """What the daemon tells and does after a restoration, beside what it told before."""

    def __init__(self, rig, told, sent, epoch):
        self.rig, self.told, self.sent, self.epoch = rig, told, sent, epoch
        self.differs = self.motions = 0

    def difference(self, what):
        self.differs += 1
        print(f"restore_differs: {what}", flush=True)

    def compare(self, client, seq, before):
        """The same within the time that pending files take."""
        changed = ["never told"]
        deadline = time.monotonic() + START_TIMEOUT_S
        while changed and time.monotonic() < deadline:
            try:
                now = fetched(client, seq)
                changed = sorted(key for key in before.keys() | now.keys() if before.get(key) != now.get(key))
            except (Answer, OSError) as error:
                changed = [str(error)]
            time.sleep(0.02)
        if changed:
            self.difference(f"seq {seq}: {', '.join(changed)}")

    def look(self):
        client = self.rig.start()
        state = client.ask("system.state")
        if state["epoch"] <= self.epoch:
            self.difference(f"epoch {state['epoch']} after {self.epoch}")
        if state["newest_seq"] < self.sent:
            self.difference(f"newest_seq {state['newest_seq']}, {self.sent} was used")
        for seq, before in self.told.items():
            self.compare(client, seq, before)
        motions = self.rig.motions()
        motions.read()
        for seq in range(1, self.sent + 1):
            try:
                reply = client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe="part")
                client.ask("job.wait", seq=seq)
                if not reply["duplicate"]:
                    print(f"restore_repeated_motions: seq {seq} began anew")
            except Answer:
                pass  # refused: it does not move
        self.motions += sum(words.startswith(("move", "home")) for _, words in motions.read())
        fresh = client.ask("system.state")["newest_seq"] + 1
        measure(client, fresh)
        epoch = client.ask("system.state")["epoch"]
        self.rig.stop()
        return fresh, epoch


def main():
    build = sys.argv[1]
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    with Rig(build, {"part": recipe(slices=5)}) as rig:
        client = rig.start()
        for seq in range(1, jobs + 1):
            measure(client, seq)
        client.ask("result.ack", seq=1)
        client.ask("job.start", seq=jobs + 1, part_id=f"part {jobs + 1}", recipe="part")
        ctl(rig, "backup", rig.folder / "backup", "--results")
        running = client.ask("job.status", seq=jobs + 1)
        if client.ask("job.wait", seq=jobs + 1)["state"] != "completed":
            sys.exit("the job beside the backup does not complete")
        for seq in range(1, jobs + 1):
            folder = client.ask("result.get", seq=seq, format="full")["directory"]
            wait_for(lambda folder=folder: files_are_made(folder), what=f"all files in {folder}")
        told = {seq: fetched(client, seq) for seq in range(1, jobs + 1)}
        for seq in range(jobs + 2, jobs + 2 + AFTER):
            measure(client, seq)
        sent, epoch = jobs + 1 + AFTER, client.ask("system.state")["epoch"]
        refused = rig.fvdctl("restore", rig.folder / "backup", "--config", rig.folder / "fvd.json")
        if refused.returncode == 0:
            sys.exit("restored while the daemon runs")
        rig.stop()
        ctl(rig, "restore", rig.folder / "backup")
        beside = Restored(rig, told, sent, epoch)
        sent, epoch = beside.look()
        shutil.rmtree(rig.state)
        ctl(rig, "restore", rig.folder / "backup")
        # Nothing is left that could tell of the number that was used last: it has to be out of reach.
        gone = Restored(rig, told, sent, min(epoch, 1))
        gone.look()
        print(f"restore: {jobs} results told before and after; the job beside the backup was "
              f"{'done' if running['done'] else 'running'} at its end")
        print(json.dumps({"restore_differs": beside.differs + gone.differs,
                          "restore_repeated_motions": beside.motions + gone.motions, "restore_jobs": jobs}))


main()
