#!/usr/bin/env python3
"""SIGKILL of the daemon, and a client that remembers what it was told.

kills.py BUILD random|acquisition|end|start|all [KILLS] [SEED]
  random       at any moment of a job
  acquisition  between two slices
  end          between the part's release and the acknowledgement: files, rename, row, reply
  start        while the daemon starts, after a kill in a job
  all          these side by side, and kill_rename_to_row.sh, which kills between rename and row by injection
The stage's motions are counted by fvd-sim: every job's slices stand at heights of their own, so that a command tells its
job. Prints a line for each violation and, last, one JSON object.
"""

import concurrent.futures
import datetime
import json
import pathlib
import random
import re
import subprocess
import sys
import time

from rig import START_TIMEOUT_S, Answer, Lost, Rig, recipe, wait_for

UNKNOWN_JOB, INTERRUPTED = 1007, 1014
SLICES = 9
STEP_UM = 10.0
LOWEST_UM = -60.0
STEPS_PER_UM = 100  # of the drive; its grid keeps the jobs' heights apart
JOBS_AT_MOST = int(STEP_UM * STEPS_PER_UM)
# A sample of the true motion and a line of the daemon's log are each known to a millisecond or two.
TIME_TOLERANCE_S = 0.004


def start_of(seq):
    return LOWEST_UM + seq / STEPS_PER_UM


class Plc:
    """Asks for jobs, remembers every answer, and compares all later answers with it."""

    def __init__(self, rig):
        self.rig = rig
        self.seq = 0
        self.ids = {}  # of acknowledged triggers, by number
        self.results = {}  # by number, as told
        self.ended = {}  # state and error as told
        self.acked = set()  # numbers whose acknowledgement was told
        self.figures = dict.fromkeys(("acked_lost", "half_visible", "verdict_changes", "orphans_left"), 0)

    def violation(self, key, what):
        self.figures[key] += 1
        print(f"{key}: {what}", flush=True)

    # --- a job ---

    def trigger(self, client, seq):
        """Asks for the job; the reply may be lost."""
        reply = client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe=f"part{seq:04}")
        self.note_id(seq, reply["job_id"])

    def note_id(self, seq, job_id):
        known = self.ids.setdefault(seq, job_id)
        if known != job_id:
            self.violation("acked_lost", f"seq {seq} was job {known} and is {job_id}")

    def note_status(self, status):
        """Any status that was told: an end must stay what it was."""
        self.note_id(status["seq"], status["job_id"])
        if not status["done"]:
            return
        end = {key: status[key] for key in ("state", "evaluation", "reason_codes", "error_code", "error_message")}
        before = self.ended.setdefault(status["seq"], end)
        if before != end:
            self.violation("verdict_changes", f"seq {status['seq']} ended as {before} and ends as {end}")

    def fetch(self, client, seq):
        """The result, with what must not change of it."""
        told = client.ask("result.get", seq=seq, format="full")
        for key in ("age_s", "durable", "files"):
            told.pop(key, None)
        if "times" in told:
            told["times"].pop("follow_ms", None)  # of files that are made later
        before = self.results.setdefault(seq, told)
        if before != told:
            changed = [key for key in before.keys() | told.keys() if before.get(key) != told.get(key)]
            self.violation("verdict_changes", f"result of seq {seq} changed in {', '.join(sorted(changed))}")
        return told

    # --- after a restart ---

    def verify(self, client, seqs):
        for seq in seqs:
            try:
                status = client.ask("job.status", seq=seq)
            except Answer as error:
                if error.code == UNKNOWN_JOB and seq not in self.ids:
                    continue  # its trigger was never acknowledged
                self.violation("acked_lost", f"seq {seq}, job {self.ids.get(seq)}: {error}")
                continue
            if not status["done"]:
                self.violation("half_visible", f"seq {seq} is {status['state']} after a restart")
            self.note_status(status)
            if seq in self.acked and not status["acknowledged"]:
                self.violation("acked_lost", f"seq {seq}: its result was acknowledged and is not")
            if status["state"] == "completed":
                self.look_at_files(client, seq)
            self.resend(client, seq, status)

    def look_at_files(self, client, seq):
        told = self.fetch(client, seq)
        folder = pathlib.Path(told["directory"])
        try:
            result = json.loads((folder / "result.json").read_text())
            short = [file["name"] for file in result["files"]
                     if file["state"] == "written" and (folder / file["name"]).stat().st_size != file["size_bytes"]]
            if result["job"]["seq"] != seq:
                short.append("result.json of another job")
        except (OSError, ValueError) as error:
            short = [str(error)]
        if short:
            self.violation("half_visible", f"seq {seq}: {', '.join(short)}")

    def resend(self, client, seq, status):
        """As a PLC does that has lost the reply: the same job, or a refusal, never another one."""
        try:
            reply = client.ask("job.start", seq=seq, part_id=f"part {seq}", recipe=f"part{seq:04}")
        except Answer as error:
            if status["error_code"] != INTERRUPTED or error.code != INTERRUPTED:
                self.violation("acked_lost", f"seq {seq}, {status['state']}, sent again: {error}")
            return
        self.note_id(seq, reply["job_id"])
        if not reply["duplicate"]:
            self.violation("acked_lost", f"seq {seq} was a job and began anew")

    def look_for_orphans(self, client):
        """Folders that no job tells as those of its result, while no job runs."""
        results = self.rig.state / "results"
        for folder in sorted(results.iterdir()) if results.exists() else []:
            try:
                # A job that failed has this name, too: known is the folder only if the result names it.
                told = client.ask("result.get", job_id=folder.name, format="full")
                is_known = pathlib.Path(told["directory"]) == folder
            except Answer:
                is_known = False
            if not is_known:
                self.violation("orphans_left", str(folder))


def run_job(rig, plc, client, pick, mode):
    """One job until the moment of the kill; answers that come in time are noted."""
    plc.seq += 1
    plc.trigger(client, plc.seq)
    if mode in ("random", "start"):
        until = time.monotonic() + pick.uniform(0.0, 1.3)
        while time.monotonic() < until:
            plc.note_status(client.ask("job.status", seq=plc.seq))
            time.sleep(0.005)
    elif mode == "acquisition":
        slices = pick.randrange(0, SLICES)
        wait_for(lambda: client.ask("job.status", seq=plc.seq)["slices_done"] >= slices, what="slices", period_s=0.001)
        time.sleep(pick.uniform(0.0, 0.05))
    else:
        client.ask("job.wait", seq=plc.seq, until="acquired")
        if pick.random() < 0.6:
            time.sleep(pick.uniform(0.0, 0.06))
            return
        plc.note_status(client.ask("job.wait", seq=plc.seq))
        plc.fetch(client, plc.seq)
        if pick.random() < 0.7:
            client.send("result.ack", seq=plc.seq)
            if pick.random() < 0.5:  # else killed with the reply on its way
                client.receive()
                plc.acked.add(plc.seq)
        time.sleep(pick.uniform(0.0, 0.02))


def kill_in_start(rig, pick):
    """A second kill while the daemon looks at what the first one left."""
    begun = rig.spawn()
    until = begun + pick.uniform(0.0, 0.5)
    while time.monotonic() < until:
        time.sleep(0.002)
    rig.kill()
    return time.time()


class Log:
    """Intervals in which the daemon's log says that the part is free, as wall times."""

    CHANGE = re.compile(r"^\[([\d-]+ [\d:.]+)\].*part_release (true|false)")

    def __init__(self, file):
        self.file = open(file, encoding="utf-8")
        self.free = []

    def read(self, killed_at):
        since = None
        for line in self.file:
            found = self.CHANGE.match(line)
            if not found:
                continue
            at = datetime.datetime.strptime(found[1], "%Y-%m-%d %H:%M:%S.%f").timestamp()
            if found[2] == "true" and since is None:
                since = at
            elif found[2] == "false" and since is not None:
                self.free.append((since, at))
                since = None
        if since is not None:
            self.free.append((since, killed_at))


def moved_while_free(free, motions):
    """Motions that reach into an interval in which the part was free."""
    to_wall = time.time() - time.monotonic()
    count = 0
    for begin, end in motions.intervals():
        begin, end = begin + to_wall + TIME_TOLERANCE_S, end + to_wall - TIME_TOLERANCE_S
        touched = [interval for interval in free if begin < interval[1] and end > interval[0]]
        for interval in touched:
            print(f"moving_while_released: {begin:.4f} to {end:.4f}, free {interval[0]:.4f} to {interval[1]:.4f}")
        count += bool(touched)
    return count


def repeated(motions, last_seq):
    """How often a job's scan went to its first slice after the first time, and how many jobs moved at all."""
    first = {f"move {start_of(seq):.6f}": seq for seq in range(1, last_seq + 1)}
    begun = {}
    for _, words in motions.lines:
        if words in first:
            begun[first[words]] = begun.get(first[words], 0) + 1
    for seq, times in begun.items():
        if times > 1:
            print(f"repeated_motions: seq {seq} went to its first slice {times} times")
    return sum(times - 1 for times in begun.values()), len(begun)


def all_of(build, kills):
    """The sum of all kinds; none may be missing."""
    here = pathlib.Path(__file__).resolve()
    commands = {mode: [sys.executable, here, build, mode, str(kills)] for mode in ("random", "acquisition", "end", "start")}
    commands["rename_to_row"] = ["bash", here.parent / "kill_rename_to_row.sh", build, str(kills)]
    running = {mode: subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for mode, command in commands.items()}
    total, failed = {"kills": 0}, False
    for mode, program in running.items():
        text, _ = program.communicate()
        print(text, end="")
        if program.returncode != 0 or not text.strip():
            print(f"kills {mode}: failed with {program.returncode}", file=sys.stderr)
            failed = True
            continue
        figures = json.loads(text.rstrip("\n").rsplit("\n", 1)[-1])
        if not figures.get(f"kills_{mode}"):
            print(f"kills {mode}: not one", file=sys.stderr)
            failed = True
        for key, value in figures.items():
            total[key] = total.get(key, 0) + value
        total["kills"] += figures.get(f"kills_{mode}", 0)
    print(json.dumps(total))
    sys.exit(failed)


def main():
    build, mode = sys.argv[1:3]
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 60
    if mode == "all":
        all_of(build, kills)
    pick = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else sum(mode.encode()))
    jobs = {f"part{seq:04}": recipe(start_um=start_of(seq), step_um=STEP_UM, slices=SLICES)
            for seq in range(1, min(JOBS_AT_MOST, 2 * kills + 10))}
    with Rig(build, jobs) as rig:
        # Every number is asked for again at the end, however long that takes.
        rig.settings["rpc.repeat_window_s"] = 86400
        plc = Plc(rig)
        log = None
        done = 0
        for i in range(kills):
            client = rig.start()
            log = log or Log(rig.folder / "fvd.log")
            plc.verify(client, range(max(1, plc.seq - 5), plc.seq + 1))
            plc.look_for_orphans(client)
            with concurrent.futures.ThreadPoolExecutor(1) as other:
                job = other.submit(run_job, rig, plc, client, pick, mode)
                if mode in ("random", "start"):
                    if i == 0:  # one at least is killed when it has moved, however slow the machine is
                        rig.motions().await_line(f"move {start_of(1):.6f}", 0, START_TIMEOUT_S)
                    time.sleep(pick.uniform(0.0, 1.2))
                else:
                    job.result()
                rig.kill()
                log.read(time.time())
                try:
                    job.result()
                except Lost:
                    pass
            client.close()
            if mode == "start":
                log.read(kill_in_start(rig, pick))
            done += 1
        client = rig.start()
        plc.verify(client, range(1, plc.seq + 1))
        plc.look_for_orphans(client)
        rig.stop()
        log.read(time.time())
        motions = rig.motions()
        motions.read()
        again, moved = repeated(motions, plc.seq)
        set_aside = rig.state / "set-aside"
        states = [end["state"] for end in plc.ended.values()]
        print(f"kills {mode}: {plc.seq} jobs, {moved} moved; at the end {states.count('completed')} completed, "
              f"{states.count('failed')} failed; {len(plc.results)} results told, {len(plc.acked)} acknowledged; "
              f"{len(list(set_aside.iterdir())) if set_aside.exists() else 0} set aside; "
              f"{len(motions.intervals())} motions, the part free {len(log.free)} times")
        if moved == 0 or not plc.ids:
            sys.exit("nothing moved: nothing was tested")
        if len(log.free) < kills / 4 or len(motions.intervals()) < kills / 4:
            sys.exit("too few motions or times of a free part: that nothing moved in them was not tested")
        print(json.dumps({f"kills_{mode}": done, **plc.figures, "repeated_motions": again, "acked": len(plc.acked),
                          "times_free": len(log.free), "motions": len(motions.intervals()),
                          "moving_while_released": moved_while_free(log.free, motions)}))


main()
