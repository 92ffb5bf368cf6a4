"""Ratios from the JSON of bench_focus, and of fvdctl process over python_triple.py. Called by run_speed.sh.

Usage: speed_figures.py WORK_FOLDER FVDCTL
"""

import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import time

import cv2
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


FORMATS = {"raw": ".tif", "pgm": ".pgm", "png": ".png", "jpeg": ".jpg"}
UNCOMPRESSED = [cv2.IMWRITE_TIFF_COMPRESSION, 1]


def write_slices(root):
    """Grain in focus at its own slice in every column, in every format."""
    random = np.random.default_rng(1)
    height, width = PROCESS_SIZE
    grain = random.uniform(-100, 100, PROCESS_SIZE)
    focus = np.linspace(4, PROCESS_SLICES - 5, width)
    for name in FORMATS:
        (root / name).mkdir()
    for k in range(PROCESS_SLICES):
        contrast = (1 + 0.1 * (k - focus) ** 2) ** -2.0
        slice_ = (126 + grain * contrast + random.integers(0, 4, PROCESS_SIZE)).astype(np.uint8)
        for name, suffix in FORMATS.items():
            cv2.imwrite(str(root / name / f"slice_{k:03d}{suffix}"), slice_, UNCOMPRESSED if name == "raw" else [])


def peak_mib(pid):
    """Resident memory at its highest so far; None once the process has ended."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return None
    found = re.search(r"VmHWM:\s+(\d+) kB", status)
    return int(found.group(1)) / 1024 if found else None


def timed(command):
    """Wall clock in s and peak resident memory in MiB of one run. The kernel's own account of a child begins with what
    its parent holds, which is more than the child here."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak = 0.0
    while process.poll() is None:
        peak = peak_mib(process.pid) or peak
        time.sleep(0.001)
    if process.returncode != 0:
        sys.exit(f"{command[0]} failed")
    return time.perf_counter() - start, peak


def process(folder):
    out = WORK / "out"
    shutil.rmtree(out, ignore_errors=True)
    seconds, mib = timed([FVDCTL, "process", str(folder), "--z-step-um", "10", "--bin", "1", "--out", str(out)])
    times = json.loads((out / "result.json").read_text())["times"]
    return seconds, mib, seconds - times["write_ms"] / 1e3


def cat_and_copy(folder):
    """To read the files and to copy their pixels once."""
    start = time.perf_counter()
    subprocess.run(["cat", *sorted(map(str, folder.iterdir()))], stdout=subprocess.DEVNULL, check=True)
    seconds = time.perf_counter() - start
    pixels = [np.ones(PROCESS_SIZE, np.uint8) for _ in range(PROCESS_SLICES)]
    copies = [np.ones(PROCESS_SIZE, np.uint8) for _ in range(PROCESS_SLICES)]
    start = time.perf_counter()
    for copy, slice_ in zip(copies, pixels):
        np.copyto(copy, slice_)
    return seconds + time.perf_counter() - start


def process_figures():
    """Medians of five runs that take turns."""
    root = WORK / "slices"
    root.mkdir()
    write_slices(root)
    script = str(pathlib.Path(__file__).with_name("python_triple.py"))
    figures = {}
    for name in FORMATS:
        folder = root / name
        ours, theirs, memory, without_files, read = [], [], [], [], []
        for _ in range(5):
            seconds, mib, computing = process(folder)
            ours.append(seconds)
            without_files.append(computing)
            seconds, python_mib = timed([sys.executable, script, str(folder), "10"])
            theirs.append(seconds)
            memory.append(mib / python_mib)
            read.append(cat_and_copy(folder))
        figures[f"process_over_python_{name}"] = statistics.median(theirs) / statistics.median(ours)
        figures[f"process_memory_over_python_{name}"] = statistics.median(memory)
        if name == "raw":
            figures["process_raw_over_cat_memcpy"] = statistics.median(without_files) / statistics.median(read)
    return figures


def main():
    median = medians()
    mono8 = "streaming/Mono8/bits:8/window:9/threads:{}/batch:8/bin:1/sml:0"
    mono16 = "streaming/Mono16/bits:16/window:9/threads:2/batch:8/bin:1/sml:0"
    second_peak = mono8.format(2).replace("Mono8", "Mono8_second_peak")
    rate = median(mono8.format(2), "Mpx/s")
    opencv = median("opencv_stored_stack/threads:2", "Mpx/s")
    slice_ms = 1e3 * PIXELS / (rate * 1e6)
    copy_ns_per_byte = 1e3 / median("copy/bytes:1", "MB/s")
    figures = {
        "default_over_opencv": rate / opencv,
        "sml9_over_opencv": median(mono8.format(2).replace("sml:0", "sml:1"), "Mpx/s") / opencv,
        "mono16_over_opencv": median(mono16, "Mpx/s") / opencv,
        "mono8_memcpy_metric": 1e3 / rate / copy_ns_per_byte,
        "state_bytes_mono8": median(mono8.format(2).replace("bin:1", "bin:4"), "state_bytes_per_pixel"),
        "state_bytes_mono8_second_peak": median(second_peak.replace("bin:1", "bin:4"), "state_bytes_per_pixel"),
        "state_bytes_mono16": median(mono16.replace("bin:1", "bin:4"), "state_bytes_per_pixel"),
        "window31_over_9": rate / median(mono8.format(2).replace("window:9", "window:31"), "Mpx/s"),
        "finish_over_slice": median("finish/Mono8/method:4/threads:2", "real_time") / slice_ms,
        **process_figures(),
        "threads2_over_1": rate / median(mono8.format(1), "Mpx/s"),
        "mono8_mpx_s": rate,
        "batch8_over_1": rate / median(mono8.format(2).replace("batch:8", "batch:1"), "Mpx/s"),
        "second_peak_over_default": median(second_peak, "Mpx/s") / rate,
        "mono12_mpx_s": median(mono16.replace("bits:16", "bits:12"), "Mpx/s"),
        "bin4_over_1": median(mono8.format(2).replace("bin:1", "bin:4"), "Mpx/s") / rate,
    }
    print(json.dumps({name: round(value, 3) for name, value in figures.items()}))


main()
