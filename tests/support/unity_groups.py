#!/usr/bin/env python3
"""Which sources of a library may be compiled together: none of a group declares a name for itself that another one does.

unity_groups.py SOURCE ...
Prints a group's number for each, separated by semicolons, as CMake reads lists. Sources that define macros, and those that the build makes, stay alone.
Names are recognised by their look, rather one too many: what is declared in an anonymous namespace, or static.
"""

import pathlib
import re
import sys

MOST = 8  # sources of a group: more take too much memory
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
DECLARED = re.compile(r"\b(?:struct|class|enum|union|using|concept)\s+(?:class\s+)?(\w+)|\b(\w+)\s*(?=[({=;\[])")
# Other names for things that are declared elsewhere: the same ones may stand twice.
SAME_EVERYWHERE = re.compile(r"\b(?:using|namespace)\s+[\w:]+\s*(?:=[^;{]*)?;")


def outermost(text, begin):
    """What stands between the brace at `begin` and its partner, without what stands in braces inside."""
    depth, kept = 0, []
    for character in text[begin:]:
        if character == "{":
            depth += 1
            if depth == 2:
                kept.append("{")
        elif character == "}":
            depth -= 1
            if depth == 0:
                break
            if depth == 1:
                kept.append("}")
        elif depth == 1:
            kept.append(character)
    return "".join(kept)


def own_names(source):
    """The names that a source declares for itself; None: it defines a macro, or is made by the build."""
    if not pathlib.Path(source).exists():
        return None
    text = COMMENT_OR_TEXT.sub(" ", pathlib.Path(source).read_text(encoding="utf-8"))
    if re.search(r"^\s*#\s*define", text, re.M):
        return None
    names = set()
    parts = [outermost(text, match.end() - 1) for match in re.finditer(r"\bnamespace\s*\{", text)]
    parts += re.findall(r"^(?:static|inline|constexpr|const)\b[^;{]*[;{]", text, re.M)
    for part in parts:
        names |= {a or b for a, b in DECLARED.findall(SAME_EVERYWHERE.sub(" ", part))}
    return names


def groups_of(sources):
    groups = []  # of (number of sources, names)
    chosen = []
    for source in sources:
        names = own_names(source)
        place = len(groups)
        if names is not None:
            fits = (i for i, (count, taken) in enumerate(groups) if 0 < count < MOST and not taken & names)
            place = next(fits, place)
        if place == len(groups):
            groups.append((0, set()))
        count, taken = groups[place]
        groups[place] = (-1, set()) if names is None else (count + 1, taken | names)
        chosen.append(place)
    return chosen


print(";".join(str(group) for group in groups_of(sys.argv[1:])))
