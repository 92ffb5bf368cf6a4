#!/usr/bin/env python3
"""Builds the operator page and makes a C++ source of it, for daemon/page.

embed_page.py --out FOLDER --source FILE.cpp [--depfile FILE] [--npm NPM --node NODE] [--must] [--no-build]
  --out       where the page is built: files.txt ("path<TAB>type" lines), the files, and each as *.gz
  --depfile   what the source depends on, for ninja and make
  --must      fail where the page cannot be built; without it the source says that there is none, a message says why,
              and the next build tries again
  --no-build  the page is in --out already
"""
import argparse
import contextlib
import fcntl
import hashlib
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
# Made by the build itself, or not the page's.
LOCK = ".build_lock"
IGNORED = {"node_modules", "dist", "methods.ts", "README.md", ".gitignore", LOCK}
PATIENCE_S = 600  # of one program; npm waits for a network that is not there
NPM_OPTIONS = ("--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries=1", "--fetch-retry-mintimeout=1000",
               "--fetch-timeout=60000")
TAG_DIGITS = 16
BYTES_A_LINE = 24


class NoPage(Exception):
    """Why there is none; for people."""


def run(command, folder):
    try:
        result = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                timeout=PATIENCE_S, check=False, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoPage(f"{command[0]}: {error}") from error
    if result.returncode != 0:
        raise NoPage(f"{' '.join(command)} failed:\n{result.stdout.strip()[-2000:]}")


def install_packages(npm, folder):
    """What the lock file names, unless it is there."""
    lock, installed = (os.path.join(folder, name) for name in ("package-lock.json", "node_modules/.package-lock.json"))
    if os.path.exists(installed) and os.path.getmtime(installed) >= os.path.getmtime(lock):
        return
    run([npm, "ci", *NPM_OPTIONS], folder)


@contextlib.contextmanager
def alone(folder):
    """Builds of several build folders share the packages and methods.ts: one waits for the other."""
    try:
        lock = open(os.path.join(folder, LOCK), "w", encoding="utf-8")
    except OSError as error:
        raise NoPage(str(error)) from error
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # until it is closed
        yield


def build(options):
    if not options.npm or not options.node:
        raise NoPage("npm and node are needed")
    with alone(HERE):
        install_packages(options.npm, HERE)
        run([options.node, "build.mjs", "--out", options.out], HERE)


def read_files(folder):
    """[(path, type, tag, packed bytes)]"""
    files = []
    try:
        with open(os.path.join(folder, "files.txt"), encoding="utf-8") as listed:
            lines = listed.read().splitlines()
        for line in lines:
            path, kind = line.split("\t")
            if not re.fullmatch(r"[A-Za-z0-9._/-]+", path) or not re.fullmatch(r"[A-Za-z0-9 ;=/+.-]+", kind):
                raise NoPage(f"files.txt: '{line}' is no path and type")
            with open(os.path.join(folder, path), "rb") as file:
                tag = hashlib.sha256(file.read()).hexdigest()[:TAG_DIGITS]
            with open(os.path.join(folder, path + ".gz"), "rb") as file:
                files.append((path, kind, tag, file.read()))
    except (OSError, ValueError) as error:
        raise NoPage(f"{folder}: {error}") from error
    if not any(path == "index.html" for path, *_ in files):
        raise NoPage(f"{folder}: index.html is missing")
    return files


def source_of(files):
    text = "// Made by daemon/web/embed_page.py.\n#include \"daemon/page/page_files.hpp\"\n"
    if files:
        text += "\n#include <array>\n\nnamespace fvd {\n\nnamespace {\n"
    for i, (_, _, _, packed) in enumerate(files):
        text += f"\nconst unsigned char kFile{i}[] = {{\n"
        for at in range(0, len(packed), BYTES_A_LINE):
            text += ",".join(str(byte) for byte in packed[at:at + BYTES_A_LINE]) + ",\n"
        text += "};\n"
    if not files:
        return text + "\nnamespace fvd {\n\nstd::span<const PageFile> page_files() noexcept { return {}; }\n\n}  // namespace fvd\n"
    text += f"\nconst std::array<PageFile, {len(files)}> kFiles{{{{\n"
    for i, (path, kind, tag, _) in enumerate(files):
        text += f'    {{"/{path}", "{kind}", "{tag}", {{reinterpret_cast<const char*>(kFile{i}), sizeof kFile{i}}}}},\n'
    return text + ("}};\n\n}  // namespace\n\nstd::span<const PageFile> page_files() noexcept { return kFiles; }\n\n"
                   "}  // namespace fvd\n")


def write_source(path, text, must_be_new):
    """One that is as it was need not be compiled again; with must_be_new it counts as written all the same."""
    if not must_be_new and os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            if file.read() == text:
                return
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def sources(folder):
    """Every file of the page's sources, and the folders: a file that is added changes its folder."""
    for parent, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name not in IGNORED)
        yield parent
        for name in sorted(names):
            if name not in IGNORED:
                yield os.path.join(parent, name)


def write_depfile(path, target, folder, again):
    # Without the folder of the packages and of a page that is built by hand: both come and go.
    wanted = [each for each in sources(folder) if each != folder]
    if again:
        wanted.append(target + ".never")  # a file that never is: the next build tries again
    with open(path, "w", encoding="utf-8") as file:
        file.write(target.replace(" ", "\\ ") + ":" +
                   "".join(" \\\n  " + each.replace(" ", "\\ ") for each in wanted) + "\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", required=True)
    parser.add_argument("--source", required=True)
    parser.add_argument("--depfile")
    parser.add_argument("--npm")
    parser.add_argument("--node")
    parser.add_argument("--must", action="store_true")
    parser.add_argument("--no-build", action="store_true")
    options = parser.parse_args()
    try:
        if not options.no_build:
            build(options)
        files = read_files(options.out)
    except NoPage as reason:
        if options.must:
            sys.exit(f"the operator page was not built: {reason}")
        print(f"the operator page was not built, and fvd is built without it (-DFVD_WEB=ON makes this an error): {reason}",
              file=sys.stderr)
        files = []
    write_source(options.source, source_of(files), must_be_new=bool(files))
    if options.depfile:
        write_depfile(options.depfile, options.source, HERE, again=not files)


main()
