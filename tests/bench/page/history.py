#!/usr/bin/env python3
"""Lists of 100,000 jobs: the first page, pages further down, and a full page with each filter; a run chart of 2,000 values.

history.py BUILD [JOBS] [ROUNDS]
Times are those of the calls by HTTP, each the slowest but 1 % of its rounds. The last line is one JSON object.
"""

import contextlib
import json
import sqlite3
import sys
import time

from http_calls import Http
from many_jobs import copy_jobs
from page_rig import PageRig
from rig import percentile, wait_for

RECIPES, VERDICTS = ("part", "second", "third", "rare"), ("pass", "fail", "uncertain", "invalid", "")
PAGE = 50  # jobs, as the page asks for them
ENDED = "strftime('%Y-%m-%dT%H:%M:%fZ', '2026-01-01', '+' || (i * 3) || ' minutes')"


def one_of(words, number="i"):
    """SQL that takes the words in turn."""
    return f"CASE {number} % {len(words)} " + " ".join(f"WHEN {n} THEN '{word}'" for n, word in enumerate(words)) + " END"


COLUMNS = {
    "acknowledged": "1", "part_id": "'part-' || printf('%06d', i)",
    # One recipe in a thousand, so that a page of it is far down.
    "recipe": f"CASE WHEN i % 1000 = 7 THEN 'rare' ELSE {one_of(RECIPES[:3])} END",
    "verdict": one_of(VERDICTS, "(i / 3)"), "ended_utc": ENDED, "created_utc": ENDED,
    "state": "CASE WHEN i % 500 = 3 THEN 'failed' ELSE 'completed' END",
    "error": "CASE WHEN i % 500 = 3 THEN 'camera_frames_lost' ELSE '' END",
}

FILTERS = {
    "part": {"part_id": "part-0500"},
    "part that is not there": {"part_id": "no-such"},
    "recipe": {"recipe": "second"},
    "rare recipe": {"recipe": "rare"},
    "recipe that is not there": {"recipe": "never"},
    "verdict": {"verdict": "fail"},
    "state": {"state": "failed"},
    "days": {"from_utc": "2026-02-01T00:00:00Z", "to_utc": "2026-02-02T00:00:00Z"},
    "old days": {"to_utc": "2026-01-01T12:00:00Z"},
    "text": {"text": "FRAMES"},
    "text that is not there": {"text": "nowhere"},
    "all at once": {"part_id": "part-", "recipe": "rare", "verdict": "pass", "state": "completed",
                    "from_utc": "2026-01-01T00:00:00Z", "text": "rare"},
}


def add_values(file):
    with contextlib.closing(sqlite3.connect(file)) as database:
        database.execute("INSERT OR REPLACE INTO job_values "
                         "(number, measurement, name, value, u, expanded_u, lower, upper, verdict) SELECT number, 'step', "
                         "'height_um', 50 + (number % 97) / 1000.0, 0.01, 0.02, 49.5, 50.5, 'pass' FROM jobs")
        database.commit()
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")


def page_of(http, wanted):
    """A full page, or all that there is: an answer looks at 20,000 jobs at most, and says where it goes on."""
    jobs, before = [], ""
    while True:
        more = {"before": before} if before else {}
        answer = http.call("job.list", most=PAGE - len(jobs), **wanted, **more)
        jobs, before = jobs + answer["jobs"], answer["next"]
        if len(jobs) == PAGE or not before:
            return jobs


def timed(rounds, ask):
    """The last answer, and the time in ms that 99 of 100 stay below."""
    times_ms, answer = [], None
    for _ in range(rounds):
        begun = time.monotonic()
        answer = ask()
        times_ms.append(1000 * (time.monotonic() - begun))
    return answer, percentile(times_ms, 0.99)


def fits(job, wanted):
    """The filter a second time, so that a fast wrong answer is none."""
    ended = job["ended_utc"][:19]
    return (job["part_id"].startswith(wanted.get("part_id", ""))
            and all(wanted.get(key, job[key]) == job[key] for key in ("recipe", "verdict", "state"))
            and wanted.get("from_utc", "")[:19] <= ended <= wanted.get("to_utc", "9")
            and wanted.get("text", "").lower() in json.dumps(job).lower())


def pages(http, count):
    """Times of pages by their cursor, in ms; ends the program if a job comes twice or is left out."""
    times_ms, before, last = [], "", None
    for _ in range(count):
        begun = time.monotonic()
        page = http.call("job.list", most=PAGE, **({"before": before} if before else {}))
        times_ms.append(1000 * (time.monotonic() - begun))
        seqs = [job["seq"] for job in page["jobs"]]
        if last is not None and seqs != list(range(last - 1, last - 1 - len(seqs), -1)):
            sys.exit(f"the page behind {last} begins with {seqs[:3]}")
        last, before = seqs[-1], page["next"]
    return times_ms


def main():
    build = sys.argv[1]
    jobs, rounds = (int(sys.argv[i]) if len(sys.argv) > i else usual for i, usual in ((2, 100_000), (3, 20)))
    with PageRig(build) as rig:
        client = rig.start()
        client.ask("job.start", seq=1, part_id="part-000001", recipe="part")
        wait_for(lambda: client.ask("job.wait", seq=1)["done"], what="a job")
        client.close()
        rig.stop()
        copy_jobs(rig.database, jobs, COLUMNS)
        add_values(rig.database)
        rig.start().close()
        http = Http(rig.http_port, rig.tokens["view"])
        first, first_ms = timed(rounds, lambda: http.call("job.list", most=PAGE))
        if len(first["jobs"]) != PAGE or first["jobs"][0]["seq"] != jobs or not first["next"]:
            sys.exit(f"the first page is wrong: {str(first)[:300]}")
        slowest_ms = 0.0
        for name, wanted in FILTERS.items():
            found, took_ms = timed(rounds, lambda wanted=wanted: page_of(http, wanted))
            print(f"history, {name}: {len(found)} jobs, {took_ms:.1f} ms", flush=True)
            if not all(fits(job, wanted) for job in found) or (not found) != ("not there" in name):
                sys.exit(f"the page of {name} is wrong: {str(found)[:300]}")
            slowest_ms = max(slowest_ms, took_ms)
        further_ms = percentile(pages(http, 40), 0.99)
        chart, chart_ms = timed(rounds, lambda: http.call("value.list", measurement="step", value="height_um", most=2000))
        if len(chart["points"]) != 2000 or chart["points"][-1]["job_id"] != first["jobs"][0]["job_id"]:
            sys.exit(f"the chart has {len(chart['points'])} points")
        http.close()
        rig.stop()
    print(json.dumps({"history_100k_ms": round(first_ms, 1), "history_100k_filter_ms": round(slowest_ms, 1),
                      "history_100k_page_ms": round(further_ms, 1), "history_100k_chart_ms": round(chart_ms, 1),
                      "history_jobs": jobs}))


main()
