#!/usr/bin/env python3
"""What daemon/web/embed_page.py makes of a page, and of one that cannot be built. Programs that stand in for npm and node."""
import gzip
import os
import re
import stat
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../..")
EMBED = os.path.join(ROOT, "daemon/web/embed_page.py")


def embed(*arguments):
    return subprocess.run([sys.executable, EMBED, *arguments], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          check=False)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class EmbedPage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.source = os.path.join(self.folder, "page_files.cpp")
        self.out = os.path.join(self.folder, "web")

    def page(self, files, listed=None):
        for path, content in files.items():
            full = os.path.join(self.out, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "wb") as file:
                file.write(content)
            with open(full + ".gz", "wb") as file:
                file.write(gzip.compress(content))
        with open(os.path.join(self.out, "files.txt"), "w", encoding="utf-8") as file:
            file.write(listed if listed is not None else "".join(f"{path}\ttext/html\n" for path in files))

    def program(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + text)
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path

    def built(self, *more):
        return embed("--out", self.out, "--source", self.source, *more)

    def assert_has_none(self):
        self.assertIn("return {};", read(self.source))
        self.assertNotIn("kFile0", read(self.source))

    def test_every_byte_is_in_the_source(self):
        content = bytes(range(256)) * 3
        self.page({"assets/a-1.js": content, "index.html": b"<html>"})
        result = self.built("--no-build", "--must")
        self.assertEqual(result.returncode, 0, result.stdout)
        text = read(self.source)
        arrays = re.findall(r"kFile\d+\[\] = \{\n([\d,\n]*)\};", text)
        self.assertEqual(len(arrays), 2)
        packed = bytes(int(number) for number in arrays[0].replace("\n", "").strip(",").split(","))
        self.assertEqual(gzip.decompress(packed), content)
        self.assertIn('{"/assets/a-1.js", "text/html", "', text)
        self.assertIn('{"/index.html", "text/html", "', text)

    def test_another_content_has_another_tag(self):
        tags = set()
        for content in (b"one", b"two", b"one"):
            self.page({"index.html": content})
            self.built("--no-build", "--must")
            tags.add(re.search(r'"text/html", "([0-9a-f]+)"', read(self.source))[1])
        self.assertEqual(len(tags), 2)

    def test_names_that_are_none_are_refused(self):
        for listed in ("index.html", "index.html\ttext/html\textra\n", 'a"b\ttext/html\n', "index.html\ttext\"\n", "missing\ttext/html\n",
                       ""):
            self.page({"index.html": b"x"}, listed)
            self.assertEqual(self.built("--no-build", "--must").returncode, 1, listed)

    def test_a_build_without_the_page_goes_on(self):
        for more in ((), ("--npm", "/nonexistent/npm", "--node", "/nonexistent/node"), ("--no-build",)):
            result = self.built(*more)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertIn("was not built", result.stdout)
            self.assert_has_none()

    def test_a_build_that_must_have_it_fails(self):
        result = self.built("--must")
        self.assertEqual(result.returncode, 1)
        self.assertFalse(os.path.exists(self.source))

    def test_a_failure_is_told_with_its_words(self):
        npm = self.program("npm", "exit 0\n")
        node = self.program("node", "echo 'a key was renamed'; exit 1\n")
        result = self.built("--npm", npm, "--node", node)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("a key was renamed", result.stdout)
        self.assert_has_none()

    def test_the_depfile_names_the_sources(self):
        depfile = self.source + ".d"
        self.built("--depfile", depfile)
        text = read(depfile)
        self.assertTrue(text.startswith(self.source + ":"))
        for name in ("src/app.ts", "index.html", "build.mjs", "package-lock.json", "/src/run"):
            self.assertIn(name, text)
        for name in ("node_modules", "/methods.ts", "README"):
            self.assertNotIn(name, text)


if __name__ == "__main__":
    unittest.main()
