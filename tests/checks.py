#!/usr/bin/env python3
"""The checks of the sources, without running any; called by tests/checks.sh.

checks.py --build FOLDER [--all] [--jobs 2] [--sanitized FILE] PART...
  parts: format clang tidy layers sizes threads writes headers
Prints every finding, and as its last line one JSON object of counts (null: that part was not asked for). Fails if there
is a finding that tests/checks_known.txt does not hold, or one that has grown beyond what it holds.
"""
import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import time

from raw_calls import LITERALS, PRODUCT, ROOT, check_threads, check_ticks, check_writes, read

KEYS = ("format_diffs", "clang_warnings", "tidy_findings", "layer_violations", "folder_circles",
        "files_over_400_lines", "tidy_files", "functions_over_80_lines", "headers_not_alone",
        "sanitized_tests", "sanitized_failed", "raw_threads", "raw_writes", "empty_sources")
CLANG = "clang++-14"
TIDY = "clang-tidy-14"
FORMAT = "clang-format-14"


def run(command, cwd=ROOT):
    return subprocess.run(command, cwd=cwd, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


def sources():
    """Every C++ source that git knows or would add."""
    listed = run(["git", "-c", "safe.directory=*", "ls-files", "--cached", "--others", "--exclude-standard"])
    if listed.returncode != 0:
        sys.exit(f"checks: git ls-files: {listed.stdout}")
    found = [p for p in listed.stdout.splitlines() if re.search(r"\.(hpp|cpp)$", p) and
             p.split("/")[0] in PRODUCT + ("tests",) and os.path.exists(os.path.join(ROOT, p))]
    if not found:
        sys.exit("checks: no sources found")
    return found


class Findings:
    """A finding: key, what it is about (path, path:function, path:check), its size, text."""

    def __init__(self):
        self.all = []

    def add(self, key, subject, size, text):
        self.all.append((key, subject, size, text))

    def count(self, key):
        return sum(1 for finding in self.all if finding[0] == key)


def known_findings():
    """{(key, subject): the size it may have} of tests/checks_known.txt."""
    known = {}
    for number, line in enumerate(read("tests/checks_known.txt").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        words = line.split(None, 3)
        if len(words) < 4 or words[0] not in KEYS or not words[2].isdigit():
            sys.exit(f"tests/checks_known.txt:{number}: KEY SUBJECT SIZE REASON expected")
        known[words[0], words[1]] = int(words[2])
    return known


class Compiler:
    """What clang needs to know of every source: the folders and macros of g++'s commands."""

    def __init__(self, build):
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            entries = json.load(file)
        self.flags = {}
        for entry in entries:
            words = shlex.split(entry["command"])
            kept, i = [], 1
            while i < len(words):
                word = words[i]
                if word == "-isystem":
                    kept += words[i:i + 2]
                    i += 1
                elif re.match(r"-(I|D|std=|m)", word):
                    kept.append(word)
                i += 1
            path = os.path.relpath(entry["file"], ROOT)
            if not path.startswith(".."):
                self.flags[path] = kept
        self.union = []
        for kept in self.flags.values():
            i = 0
            while i < len(kept):
                step = 2 if kept[i] == "-isystem" else 1
                words = kept[i:i + step]
                if not words[0].startswith("-m") and " ".join(words) not in [" ".join(u) for u in self.union]:
                    self.union.append(words)
                i += step
        self.union = [word for words in self.union for word in words]

    def command(self, flags, path):
        return [CLANG, *flags, "-x", "c++", "-fsyntax-only", "-Wall", "-Wextra", "-Wthread-safety",
                "-fno-caret-diagnostics", "-fno-color-diagnostics", path]


DIAGNOSTIC = re.compile(r"^(.+?):(\d+):(\d+): (warning|error|fatal error): (.*?)(?: \[([\w.,-]+)\])?$")


def diagnostics(output):
    """(path, line, column, text, name of the check) of every warning and error."""
    for line in output.splitlines():
        match = DIAGNOSTIC.match(line)
        if match:
            path = os.path.relpath(os.path.join(ROOT, match[1]), ROOT)
            yield path, match[2], match[3], match[5], (match[6] or match[4]).split(",")[0]


def check_format(findings, files, jobs):
    def one(path):
        return path, run([FORMAT, "--dry-run", "-Werror", path])

    for path, result in jobs.map(one, files):
        if result.returncode != 0:
            findings.add("format_diffs", path, 1, f"{path}: clang-format would change it ({FORMAT} -i {path})")


def check_clang(findings, compiler, jobs):
    def one(path):
        return path, run(compiler.command(compiler.flags[path], path))

    seen = set()
    for path, result in jobs.map(one, sorted(compiler.flags)):
        found = list(diagnostics(result.stdout))
        if result.returncode != 0 and not found:
            found = [(path, "1", "1", result.stdout.strip()[-300:], "error")]
        for where, line, column, text, name in found:
            if (where, line, column, name) not in seen:
                seen.add((where, line, column, name))
                findings.add("clang_warnings", f"{where}:{name}", 1, f"{where}:{line}: {text} [{name}]")


def first_include(path):
    match = re.search(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^">]+)[">]', read(path), re.MULTILINE)
    return match[1] if match else None


def check_headers(findings, compiler, files, jobs):
    """A header that a compiled source includes before anything else is shown to stand alone by the compilation."""
    shown = {first_include(path) for path in compiler.flags}
    headers = [p for p in files if p.endswith(".hpp") and not p.endswith("-inl.hpp") and p not in shown]

    def one(path):
        return path, run(compiler.command(compiler.union + ["-Wno-pragma-once-outside-header"], path))

    for path, result in jobs.map(one, headers):
        if result.returncode != 0:
            first = next((f"line {d[1]}: {d[3]}" for d in diagnostics(result.stdout)), result.stdout[-200:])
            findings.add("headers_not_alone", path, 1, f"{path}: does not compile alone: {first}")


def version_commits():
    """The commits that set the version, last first."""
    log = run(["git", "-c", "safe.directory=*", "log", "--format=%H", r"-Gproject\(fvd VERSION", "--", "CMakeLists.txt"])
    return log.stdout.split() if log.returncode == 0 else []


def tidy_paths(every, files):
    """What changed since the version was set; where nothing did, or history does not say, since the one before, or all."""
    product = [p for p in files if p.endswith(".cpp") and p.split("/")[0] in PRODUCT]
    if every:
        return product
    for commit in version_commits():
        changed = run(["git", "-c", "safe.directory=*", "diff", "-M", "--name-status", "--diff-filter=d", commit])
        names = {words[-1] for words in (line.split("\t") for line in changed.stdout.splitlines()) if words[0] != "R100"}
        chosen = [p for p in product if p in names]
        if chosen:
            return chosen
    return product


def check_tidy(findings, build, paths, jobs):
    def one(path):
        return path, run([TIDY, "--quiet", "-p", build, path])

    seen = {}
    for path, result in jobs.map(one, paths):
        found = list(diagnostics(result.stdout))
        if result.returncode != 0 and not found:
            found = [(path, "1", "1", result.stdout.strip()[-300:], "error")]
        for where, line, column, text, name in found:
            if name.startswith("clang-diagnostic-") and name != "clang-diagnostic-error":
                continue  # g++'s warning flags, read by clang: check_clang has its own
            seen[where, line, column, name] = text
    grouped = {}
    for (where, line, _, name), text in sorted(seen.items()):
        grouped.setdefault(f"{where}:{name}", []).append(f"{where}:{line}: {text} [{name}]")
    for subject, texts in grouped.items():
        for i, text in enumerate(texts, 1):
            findings.add("tidy_findings", subject, i, text)


def check_layers(findings):
    result = run([sys.executable, os.path.join(ROOT, "tests/folder_graph.py"), "--json"])
    if result.returncode != 0:
        sys.exit(f"checks: folder_graph.py: {result.stdout}")
    for key, texts in json.loads(result.stdout).items():
        for text in texts:
            findings.add(key, text.split(":")[0].replace(" ", ""), 1, text)


# What stands before the brace of a function's body.
FUNCTION = re.compile(r"\)\s*(const|noexcept|override|final|mutable|&|FVD_\w+(\([^()]*\))?|->[^;{}]*|"
                      r":[^;]*|\s)*$", re.DOTALL)


def functions(text):
    """(name, first line, number of lines) of every function that is no lambda within another. Knows the project's form of
    writing, not the language."""
    code = LITERALS.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    code = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: re.sub(r"[^\n]", " ", m[0]), code, flags=re.MULTILINE)
    found, stack, begin = [], [], 0
    inside = 0  # depth of the function that is open, 0: none
    for match in re.finditer(r"[{};]", code):
        at = match.start()
        if match[0] == "{":
            head = code[begin:at]
            stripped = head.strip()
            is_function = False
            if not inside and not re.match(r"(inline\s+)?namespace\b", stripped) and "(" in head:
                plain = re.sub(r"<[^<>()]*>", "", stripped)
                is_type = re.match(r"(template\s*)?(class|struct|union|enum)\b", plain) and not FUNCTION.search(plain)
                if not is_type and not re.search(r"=\s*$", stripped) and FUNCTION.search(stripped):
                    is_function = True
            stack.append((is_function, begin + len(head) - len(head.lstrip()), stripped))
            if is_function:
                inside = len(stack)
        elif match[0] == "}" and stack:
            is_function, start, head = stack.pop()
            if is_function:
                inside = 0
                first = code.count("\n", 0, start) + 1
                lines = code.count("\n", start, at) + 1
                test = re.match(r"(?:TEST|TEST_F|TEST_P)\s*\(\s*(\w+)\s*,\s*(\w+)", head)
                name = f"{test[1]}.{test[2]}" if test else re.search(r"([\w:~]+|operator\S+)\s*\(", head)
                found.append((name if isinstance(name, str) else (name[1] if name else "?"), first, lines))
        if not inside:
            begin = match.end()
    return found


def check_sizes(findings, files):
    seen = 0
    for path in files:
        text = read(path)
        lines = text.count("\n")
        if not text.strip() or (path.endswith("_test.cpp") and not re.search(r"^(TYPED_)?TEST", text, re.MULTILINE)):
            findings.add("empty_sources", path, 1, f"{path}: is empty, or a test file without a test")
        if lines > 400:
            findings.add("files_over_400_lines", path, lines, f"{path}: {lines} lines")
        for name, first, length in functions(text):
            seen += 1
            if length > 80:
                findings.add("functions_over_80_lines", f"{path}:{name}", length, f"{path}:{first}: {name}: {length} lines")
    if seen < len(files):
        sys.exit(f"checks: found {seen} functions in {len(files)} files; the search for functions is broken")


def judge(findings):
    """Prints the findings; the number of those that are not held by the list of known ones."""
    known, used, bad = known_findings(), set(), 0
    for key, subject, size, text in findings.all:
        held = known.get((key, subject))
        used.add((key, subject))
        if held is not None and size <= held:
            print(f"known: {key}: {text}")
        else:
            bad += 1
            print(f"NEW: {key}: {text}" + (f" (held at {held})" if held else ""))
    asked = {finding[0] for finding in findings.all}
    for key, subject in known:
        if key in asked and key != "tidy_findings" and (key, subject) not in used:
            print(f"mended: {key} {subject}: take it out of tests/checks_known.txt")
    return bad


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sanitized", help="JSON object with the counts of the sanitized run")
    parser.add_argument("parts", nargs="*")
    options = parser.parse_args()

    findings, counts, files = Findings(), dict.fromkeys(KEYS), sources()
    compiler = Compiler(options.build) if {"clang", "headers"} & set(options.parts) else None
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as jobs:
        for part in options.parts:
            begun = time.monotonic()
            keys = []
            if part == "format":
                keys = ["format_diffs"]
                check_format(findings, files, jobs)
            elif part == "clang":
                keys = ["clang_warnings"]
                check_clang(findings, compiler, jobs)
            elif part == "headers":
                keys = ["headers_not_alone"]
                check_headers(findings, compiler, files, jobs)
            elif part == "tidy":
                keys = ["tidy_findings"]
                paths = tidy_paths(options.all, files)
                counts["tidy_files"] = len(paths)
                check_tidy(findings, options.build, paths, jobs)
            elif part == "layers":
                keys = ["layer_violations", "folder_circles"]
                check_layers(findings)
            elif part == "sizes":
                keys = ["files_over_400_lines", "functions_over_80_lines", "empty_sources"]
                check_sizes(findings, files)
            elif part == "threads":
                keys = ["raw_threads"]
                check_threads(findings, files)
                check_ticks(findings, files)
            elif part == "writes":
                keys = ["raw_writes"]
                check_writes(findings, files)
            else:
                sys.exit(f"checks: no part {part}")
            for key in keys:
                counts[key] = findings.count(key)
            print(f"checks: {part}: {time.monotonic() - begun:.0f} s", flush=True)

    bad = judge(findings)
    if options.sanitized:
        with open(options.sanitized, encoding="utf-8") as file:
            counts.update(json.load(file))
        if counts["sanitized_failed"] or not counts["sanitized_tests"]:
            bad += 1
    print(json.dumps(counts))
    sys.exit(1 if bad else 0)


main()
