"""Calls that have a better place: threads and mutexes of the standard library, threads without ticks, writes past FileCalls.

Parts of checks.py. findings: where each is added; files: paths below the project's root.
"""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PRODUCT = ("core", "config", "drivers", "sim", "daemon")
LITERALS = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/',
                      re.DOTALL)


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


RAW_THREAD = re.compile(r"std::(?:async\b(?!\(\s*std::launch::deferred)|j?thread\s*[({]|j?thread\s+(?!start_thread\b)\w+\s*[({](?!\s*[)}])|make_unique<std::j?thread>"
                        r"|mutex\b|(?:recursive|shared|timed)_\w*mutex\b|condition_variable\w*\b"
                        r"|lock_guard\b|unique_lock\b|scoped_lock\b)|\bpthread_create\b")
# Where the standard library's own are used, and why.
RAW_THREAD_ALLOWED = {
    "core/base/mutex.hpp": "the annotated ones are made of them",
    "core/runtime/guarded_thread.cpp": "the one function that starts threads",
}


def check_threads(findings, files):
    """Threads start through start_thread, and mutexes carry annotations: in everything that is no test."""
    for path in files:
        if path.split("/")[0] not in PRODUCT or path in RAW_THREAD_ALLOWED:
            continue
        code = LITERALS.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), read(path))
        seen = {}
        for match in RAW_THREAD.finditer(code):
            seen.setdefault(code.count("\n", 0, match.start()) + 1, match[0].rstrip("({ "))
        for i, (line, what) in enumerate(sorted(seen.items()), 1):
            findings.add("raw_threads", path, i, f"{path}:{line}: {what}: use start_thread (core/runtime/guarded_thread.hpp), "
                         "Mutex, MutexLock and Condition (core/base/mutex.hpp)")
    for path in RAW_THREAD_ALLOWED:
        if not RAW_THREAD.search(read(path)):
            sys.exit(f"checks: {path} needs no exception in RAW_THREAD_ALLOWED, or the search is broken")


START_THREAD = re.compile(r'\bstart_thread\(\s*("[^"]*"|[\w:]+(?:\([^()]*\))?)\s*,')
# Threads without ticks of their own, by where they start and their name there: who watches over them.
UNTICKED = {
    ("core/scan/continuous_scan.cpp", '"fvd-sweep"'): "the stage's sweep: the machine's thread waits for it by its slices",
    ("daemon/jobs/jog.cpp", '"fvd-jog"'): "waits for the next repeat and does nothing else",
    ("daemon/devices/left_threads.cpp", "std::move(name)"): "one call of a device, which its caller waits for",
    ("daemon/ctl/stop_on_signal.cpp", '"fvdctl-signals"'): "no part of the service",
}


def has_ticks(path, name, files):
    """A literal names its thread in the whole folder, a variable in its own file alone."""
    ticks = re.compile(r"(?:ThreadTicks\s+\w+|\bticks_|\bticks\.emplace_back)\s*[({]\s*" + re.escape(name) + r"\s*,")
    place = os.path.dirname if name.startswith('"') else lambda file: os.path.splitext(file)[0]
    return any(ticks.search(read(file)) for file in files if place(file) == place(path))


def check_ticks(findings, files):
    """A thread of the service ticks, so that one that hangs is noticed (core/runtime/thread_ticks.hpp)."""
    seen, threads = set(), 0
    for path in files:
        if path.split("/")[0] not in ("core", "drivers", "daemon"):
            continue
        for match in START_THREAD.finditer(re.sub(r"//[^\n]*", "", read(path))):
            threads += 1
            if (path, match[1]) in UNTICKED:
                seen.add((path, match[1]))
            elif not has_ticks(path, match[1], files):
                findings.add("raw_threads", path, 1, f"{path}: thread {match[1]} has no ThreadTicks in its folder (or, with a name "
                             "that is no literal, in its file): have it tick, or say in UNTICKED who watches over it")
    if threads < 10 or set(UNTICKED) - seen:
        sys.exit(f"checks: an exception in UNTICKED is not needed, or the search for threads is broken: {set(UNTICKED) - seen}")


RAW_WRITE = re.compile(r"std::(?:basic_)?o?fstream\b|\bfopen\b|\bO_(?:WRONLY|RDWR|CREAT|TMPFILE)\b"
                       r"|(?:fs|filesystem)::(?:create_\w+|remove|remove_all|rename|copy|copy_file|copy_symlink|resize_file"
                       r"|permissions|last_write_time)\s*\(|(?<![\w>.])std::(?:rename|remove)\s*\(\s*\w+\.c_str"
                       r"|(?<!\w)::(?:rename\w*|link|symlink|unlink\w*|mkdir\w*|rmdir|mkfifo|mknod|creat|p?writev?|fsync|fdatasync|sync"
                       r"|sync_file_range|f?truncate|fallocate|posix_fallocate|f?chmod|[lf]?chown|mkstemp|mkdtemp)\s*\("
                       r"|\bsqlite3_open\w*|\bTIFFOpen(?:W|Ext|ExtR)?\s*\(|\bimwrite\b|\bsurface_write_to_png\b")
# Where the daemon and its drivers write without FileCalls, by which words, and why.
RAW_WRITE_ALLOWED = {
    "daemon/export/file_calls.cpp": ({"O_RDWR", "O_CREAT", "::write", "::fsync", "::posix_fallocate", "::mkdir", "::rename",
                                      "::renameat2", "::unlink", "::rmdir", "::chmod", "::lchown", "filesystem::remove_all"},
                                     "the one place: every call of the system is here"),
    "daemon/export/durable_file.cpp": ({"::sync_file_range"}, "a head start whose failure means nothing: fsync() tells"),
    "daemon/store/database.cpp": ({"sqlite3_open_v2"}, "SQLite writes by calls of its own; tests fail those: broken_disk.hpp"),
    "daemon/store/database_copy.cpp": ({"sqlite3_open_v2"}, "the same"),
    "daemon/transport/unix_socket.cpp": ({"*"}, "a socket's name holds nothing; whoever cannot make it does not start"),
    "drivers/common/drive_lock.cpp": ({"O_RDWR", "O_CREAT", "::ftruncate", "::fchmod", "::mkdir", "::chmod", "::unlink", "::pwrite"},
                                      "a lock in memory (/run/lock); whoever cannot write it is refused the drive"),
    "drivers/common/text_line.cpp": ({"O_RDWR", "::write"}, "a serial line"),
    "drivers/modbus/modbus_transport.cpp": ({"O_RDWR", "std::ofstream"}, "a serial line, and the kernel's latency timer of it"),
    "drivers/replay/tiff_handle.cpp": ({"TIFFOpenExt"}, "it reads"),
    "drivers/replay/image_file_png.cpp": ({"fopen"}, "it reads"),
}


def check_writes(findings, files):
    """What is written goes through FileCalls, so that tests can fail each call: in the daemon and its drivers."""
    used = set()
    for path in files:
        if path.split("/")[0] not in ("core", "config", "drivers", "daemon"):
            continue
        allowed = RAW_WRITE_ALLOWED.get(path, (set(), ""))[0]
        code = LITERALS.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), read(path))
        found = 0
        for match in RAW_WRITE.finditer(code):
            word = re.sub(r"\s*\(.*", "", match[0])
            used.update({(path, word), (path, "*")})
            if not {word, "*"} & allowed:
                found += 1
                findings.add("raw_writes", path, found, f"{path}:{code.count(chr(10), 0, match.start()) + 1}: {word}: write by "
                             "FileCalls (daemon/export/file_calls.hpp), or say in RAW_WRITE_ALLOWED why not")
    for path, (words, _) in RAW_WRITE_ALLOWED.items():
        for word in sorted(words):
            if (path, word) not in used:
                sys.exit(f"checks: {path} needs no exception for {word} in RAW_WRITE_ALLOWED, or the search is broken")
