"""Ratios from the JSON of bench_focus, and of fvdctl process over python_triple.py. Called by run_speed.sh.

Usage: speed_figures.py WORK_FOLDER FVDCTL
"""

import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

import numpy as np

WORK = pathlib.Path(sys.argv[1])
FVDCTL = sys.argv[2]
PIXELS = 2448 * 2048
PROCESS_SIZE = (1080, 1920)
PROCESS_SLICES = 30


def medians():
    """Median counters of each benchmark by its name."""
    runs = {}
    for run in json.loads((WORK / "focus.json").read_text())["benchmarks"]:
        if run.get("run_type") == "iteration":
            runs.setdefault(run["run_name"].replace("/manual_time", "").replace("/real_time", ""), []).append(run)

    def median(name, key):
        return statistics.median(run[key] for run in runs[name])

    return median


def write_slices(folder):
    """Grain in focus at its own slice in every column, as PGM."""
    folder.mkdir()
    random = np.random.default_rng(1)
    height, width = PROCESS_SIZE
    grain = random.uniform(-100, 100, PROCESS_SIZE)
    focus = np.linspace(4, PROCESS_SLICES - 5, width)
    for k in range(PROCESS_SLICES):
        contrast = (1 + 0.1 * (k - focus) ** 2) ** -2.0
        slice_ = (126 + grain * contrast + random.integers(0, 4, PROCESS_SIZE)).astype(np.uint8)
        with open(folder / f"slice_{k:03d}.pgm", "wb") as file:
            file.write(f"P5\n{width} {height}\n255\n".encode() + slice_.tobytes())


def timed(command):
    """Wall clock in s and peak resident memory in MiB of one run."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{command[0]} failed")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


def process_against_python():
    slices = WORK / "slices"
    write_slices(slices)
    out = WORK / "out"
    script = str(pathlib.Path(__file__).with_name("python_triple.py"))
    ours, theirs, memory = [], [], []
    for _ in range(5):
        shutil.rmtree(out, ignore_errors=True)
        seconds, mib = timed([FVDCTL, "process", str(slices), "--z-step-um", "10", "--out", str(out)])
        ours.append(seconds)
        seconds, python_mib = timed([sys.executable, script, str(slices), "10"])
        theirs.append(seconds)
        memory.append(mib / python_mib)
    return statistics.median(theirs) / statistics.median(ours), statistics.median(memory)


def main():
    median = medians()
    mono8 = "streaming/Mono8/bits:8/window:9/threads:{}/batch:8/bin:1"
    mono16 = "streaming/Mono16/bits:16/window:9/threads:2/batch:8/bin:1"
    rate = median(mono8.format(2), "Mpx/s")
    opencv = median("opencv_stored_stack/threads:2", "Mpx/s")
    slice_ms = 1e3 * PIXELS / (rate * 1e6)
    copy_ns_per_byte = 1e3 / median("copy/bytes:1", "MB/s")
    ratio, memory = process_against_python()
    figures = {
        "mono8_over_opencv": rate / opencv,
        "mono16_over_opencv": median(mono16, "Mpx/s") / opencv,
        "mono8_memcpy_metric": 1e3 / rate / copy_ns_per_byte,
        "state_bytes_mono8": median(mono8.format(2).replace("bin:1", "bin:4"), "state_bytes_per_pixel"),
        "state_bytes_mono16": median(mono16.replace("bin:1", "bin:4"), "state_bytes_per_pixel"),
        "window31_over_9": rate / median(mono8.format(2).replace("window:9", "window:31"), "Mpx/s"),
        "finish_over_slice": median("finish/Mono8/method:4/threads:2", "real_time") / slice_ms,
        "process_over_python": ratio,
        "process_memory_over_python": memory,
        "threads2_over_1": rate / median(mono8.format(1), "Mpx/s"),
        "mono8_mpx_s": rate,
        "batch8_over_1": rate / median(mono8.format(2).replace("batch:8", "batch:1"), "Mpx/s"),
        "mono12_mpx_s": median(mono16.replace("bits:16", "bits:12"), "Mpx/s"),
        "bin4_over_1": median(mono8.format(2).replace("bin:1", "bin:4"), "Mpx/s") / rate,
    }
    print(json.dumps({name: round(value, 3) for name, value in figures.items()}))


main()
