#!/usr/bin/env python3
"""Man pages and completions hold what the programs say of themselves: man_pages_test.py FVD FVDCTL FVD_SIM"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
FVD, FVDCTL, FVD_SIM = sys.argv[1:4]


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def plain(page):
    """A page without what troff takes for its own."""
    text = re.sub(r"\\f[BIR]", "", page.read_text(encoding="utf-8"))
    return text.replace("\\-", "-").replace("\\e", "\\").replace("\\&", "")


def helps(program, words=()):
    """The help of a program and of every command below it."""
    text = run(program, *words, "--help")
    yield words, text
    commands = re.search(r"^Subcommands:\n((?:  .*\n)*)", text, re.M)
    for name in re.findall(r"^  (\S+)", commands[1], re.M) if commands else []:
        yield from helps(program, (*words, name))


class ThePages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        run(sys.executable, str(ROOT / "daemon/man/make_pages.py"), "--fvd", FVD, "--fvdctl", FVDCTL, "--fvd-sim",
            FVD_SIM, "--keys", str(ROOT / "config/README.md"), "--version", "1.2.3", "--out", cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_have_every_option_of_help(self):
        for program, page in ((FVD, "fvd.8"), (FVDCTL, "fvdctl.1"), (FVD_SIM, "fvd-sim.1")):
            name = page.rpartition(".")[0]
            text = plain(self.out / page)
            seen = 0
            for words, shown in helps(program):
                section = text
                if words and "Subcommands:" not in shown:
                    self.assertIn(f'.SS "{name} {" ".join(words)}"', text)
                    section = text.split(f'.SS "{name} {" ".join(words)}"')[1].split(".SS")[0]
                for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", shown, re.M):
                    if option != "--help":
                        seen += 1
                        self.assertIn(option, section, f"{page} {words}")
            self.assertGreater(seen, 5)
        self.assertIn("--motion-log", plain(self.out / "fvd-sim.1"))

    def test_have_the_text_of_a_name_that_fills_its_column(self):
        text = plain(self.out / "fvdctl.1")
        self.assertRegex(text, r"(?m)^--recipe TEXT:FILE REQUIRED\nfile of a recipe with a section evaluation$")
        self.assertRegex(text, r"(?m)^--speed-um-per-s FLOAT=1000\nspeed of moves$")

    def test_have_every_key(self):
        def paths(schema, prefix=""):
            for name, value in schema["properties"].items():
                if name == "$schema":
                    continue
                yield prefix + name
                if "properties" in value:
                    yield from paths(value, prefix + name + ".")

        for option, page in (("--print-config-schema", "fvd.json.5"), ("--print-recipe-schema", "fvd-recipe.5")):
            text = plain(self.out / page)
            schema = json.loads(run(FVD, option))
            for path in paths(schema):
                self.assertRegex(text, rf"(?m)^{re.escape(path)}\b", page)

    def test_leave_no_mark_of_the_template(self):
        for page in self.out.glob("*.[158]"):
            self.assertNotRegex(page.read_text(encoding="utf-8"), r"@[A-Z]+@", page.name)
            self.assertIn("1.2.3", page.read_text(encoding="utf-8"))

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_please_groff(self):
        for page in self.out.glob("*.[158]"):
            said = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", str(page)], check=False, capture_output=True,
                                  text=True)
            self.assertEqual((said.returncode, said.stderr), (0, ""), page.name)

    def test_complete_commands_and_options(self):
        def completed(program, *words):
            script = (f"source {self.out / (program + '.bash')}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); "
                      f"_{program}; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
            return run("bash", "-c", script, program, program, *words).split()

        self.assertIn("start", completed("fvdctl", "st"))
        self.assertIn("stage", completed("fvdctl", "st"))
        self.assertEqual(completed("fvdctl", "stage", "acc"), ["accuracy"])
        self.assertEqual(completed("fvdctl", "--address", "1.2.3.4:5", "stage", "stop", "--con"), ["--config"])
        self.assertEqual(completed("fvd", "--check-c"), ["--check-config"])
        self.assertEqual(completed("fvd-sim", "run", "--camera-a"), ["--camera-address"])
        self.assertEqual(completed("fvd-sim", "run", "--mot"), ["--motion-log"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
