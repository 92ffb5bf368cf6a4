#!/usr/bin/env python3
"""Man pages and completions of bash, from what the programs and the tables of keys say of themselves.

make_pages.py --fvd PROGRAM --fvdctl PROGRAM --fvd-sim PROGRAM --keys config/README.md --version V --out FOLDER
Writes fvd.8, fvdctl.1, fvd-sim.1, fvd.json.5, fvd-recipe.5, fvd.bash, fvdctl.bash and fvd-sim.bash. The date is that of
SOURCE_DATE_EPOCH, if set.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).parent
COLUMN = 30  # where --help begins the texts


class Entry:
    """An option, a positional or a subcommand: its names, the word for its value, what it is for."""

    def __init__(self, head, text):
        names, _, self.value = head.partition(" ")
        self.names = names.split(",")
        self.value = self.value.strip()
        self.text = text


class Command:
    """A command of a program, read from its --help: sections of entries, and the commands below it."""

    def __init__(self, program, words=()):
        self.words = list(words)
        run = subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"make_pages.py: {program} {' '.join(words)} --help: {run.returncode}: {run.stderr}")
        self.about, self.sections = self._read(run.stdout)
        self.commands = [Command(program, [*words, entry.names[0]]) for entry in self.sections.get("Subcommands", [])]

    @staticmethod
    def _read(text):
        sections, entries, about = {}, None, []
        lines = text.splitlines()
        for line, following in zip(lines, lines[1:] + [""]):
            if re.match(r"\S.*:$", line):
                entries = sections.setdefault(line[:-1], [])
            elif entries is None:
                if line.strip() and not line.startswith("Usage:"):
                    about.append(line.strip())
            elif re.match(r"  \S", line):
                # A name that fills its column has one blank behind it; a longer one has its text in the next line.
                fills = line[COLUMN - 1:COLUMN] == " " and not following.startswith(" " * COLUMN)
                head, rest = (line[2:COLUMN], line[COLUMN:]) if fills else (line[2:], "")
                entries.append(Entry(head.strip(), rest.strip()))
            elif line.strip() and entries:
                entries[-1].text = (entries[-1].text + " " + line.strip()).strip()
        return " ".join(about), sections

    def entries(self, *sections):
        return [entry for section in sections for entry in self.sections.get(section, [])]

    def all(self):
        yield self
        for command in self.commands:
            yield from command.all()


def roff(text):
    """Text that troff prints as it is."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def definitions(entries):
    lines = []
    for entry in entries:
        names = ", ".join(f"\\fB{roff(name)}\\fR" for name in entry.names)
        lines += [".TP", names + (f" \\fI{roff(entry.value)}\\fR" if entry.value else ""), roff(entry.text or "\\&")]
    return "\n".join(lines)


def command_sections(root, name):
    parts = []
    for command in root.all():
        if not command.words or command.commands:
            continue
        parts.append(f'.SS "{name} {" ".join(command.words)}"')
        if command.about:
            parts.append(roff(command.about))
        own = command.entries("Positionals", "Options")
        parts.append(definitions([entry for entry in own if "--help" not in entry.names]))
    return "\n".join(part for part in parts if part)


def keys(readme, table):
    """The rows of the table of keys as definitions."""
    match = re.search(rf"<!-- keys: {re.escape(table)} -->\n(.*?)<!-- end -->", readme, re.S)
    if not match:
        sys.exit(f"make_pages.py: there is no table of keys {table}")
    lines = []
    for row in match[1].splitlines()[2:]:
        cells = [cell.strip().replace("\\|", "|").replace("`", "") for cell in re.split(r"(?<!\\)\|", row)[1:-1]]
        key, accepted, default, meaning = cells
        lines += [".TP", f"\\fB{roff(key)}\\fR", roff(meaning or "\\&"), ".br",
                  roff(f"Accepted: {accepted}. Default: {default}.")]
    return "\n".join(lines)


def completion(root, name):
    """A case for each command: the words that can follow it."""
    cases = []
    for command in root.all():
        words = [c.words[-1] for c in command.commands]
        words += [option for entry in command.entries("Options") for option in entry.names if option.startswith("--")]
        cases.append(f'    "{" ".join(command.words)}") words="{" ".join(words)}" ;;')
    known = "|".join('"' + " ".join(c.words) + '"' for c in root.all() if c.words) or '""'
    return f"""# completion of bash for {name}; made by make_pages.py
_{name}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} path="" words="" word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "${{path:+$path }}$word" in
      {known}) path="${{path:+$path }}$word" ;;
    esac
  done
  case "$path" in
{chr(10).join(cases)}
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o bashdefault -o default -F _{name} {name}
"""


def main():
    parser = argparse.ArgumentParser()
    for option in ("fvd", "fvdctl", "fvd-sim", "keys", "version", "out"):
        parser.add_argument("--" + option, required=True)
    options = parser.parse_args()
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    fvd, fvdctl, fvd_sim = Command(options.fvd), Command(options.fvdctl), Command(options.fvd_sim)
    readme = pathlib.Path(options.keys).read_text(encoding="utf-8")
    date = time.strftime("%Y-%m-%d", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))))
    pages = {"fvd.8": {"OPTIONS": definitions(fvd.entries("Positionals", "Options"))},
             "fvdctl.1": {"OPTIONS": definitions(fvdctl.entries("Options")), "COMMANDS": command_sections(fvdctl, "fvdctl")},
             "fvd-sim.1": {"COMMANDS": command_sections(fvd_sim, "fvd-sim")},
             "fvd.json.5": {"KEYS": keys(readme, "fvd.json")},
             "fvd-recipe.5": {"KEYS": keys(readme, "recipe")}}
    for page, parts in pages.items():
        text = (HERE / (page + ".in")).read_text(encoding="utf-8")
        for name, value in {**parts, "DATE": date, "VERSION": options.version}.items():
            text = text.replace(f"@{name}@", value)
        (out / page).write_text(text, encoding="utf-8")
    for root, name in ((fvd, "fvd"), (fvdctl, "fvdctl"), (fvd_sim, "fvd-sim")):
        (out / (name + ".bash")).write_text(completion(root, name), encoding="utf-8")


main()
