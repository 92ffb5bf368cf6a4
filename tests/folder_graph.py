#!/usr/bin/env python3
"""Who includes whom, folder by folder.

folder_graph.py                 layers and circles: prints every offence and fails if there is one
folder_graph.py --json          their counts and offences as one JSON object
folder_graph.py --draw          the drawing of the folders
folder_graph.py --readme check  fails unless the top-level README holds that drawing; --readme write puts it there
"""
import argparse
import collections
import json
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TOPS = ("core", "config", "drivers", "sim", "daemon")
SOURCE = re.compile(r"\.(hpp|cpp|inc|hpp\.in)$")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^">]+)[">]', re.MULTILINE)

# (why, pattern of the include, folder, paths that may)
FORBIDDEN = [
    ("core includes core only", r"(config|drivers|sim|daemon|tests)/", "core", None),
    ("core has no JSON, logging, device or image library",
     r"(nlohmann|spdlog|arv|modbus|opencv2|boost|sqlite3|CLI)", "core", r"^core/metrology/"),
    ("metrology has no JSON, logging, device or image library; of Boost only Math",
     r"(nlohmann|spdlog|arv|modbus|opencv2|boost/(?!math/)|sqlite3|CLI)", "core/metrology", None),
    ("config includes core only", r"(drivers|sim|daemon|tests)/", "config", None),
    ("drivers know nothing of daemon and sim", r"(sim|daemon|tests)/", "drivers", None),
    ("sim knows only core and config", r"(drivers|daemon|tests)/", "sim", None),
    ("the daemon has no simulator code", r"(sim|tests)/", "daemon", None),
    ("Aravis stays in its driver", r"arv", "daemon", None),
    ("views have no sockets, no HTTP and no JSON-RPC", r"(boost|daemon/(api|resources|transport))/", "daemon/views", None),
    ("resources have no sockets and no JSON-RPC", r"(boost|daemon/api)/", "daemon/resources", None),
    ("transport knows resources by their interface", r"daemon/(resources|views)/", "daemon/transport", None),
    ("Aravis stays in its driver", r"arv", "drivers", r"^drivers/aravis/"),
    ("libmodbus stays in its driver", r"modbus/", "drivers", r"^drivers/(modbus|registry)/"),
    ("JSON in drivers is for drive profiles", r"nlohmann", "drivers", r"^drivers/modbus/drive_profile"),
    ("JSON in sim is for its configuration and figures", r"nlohmann", "sim", r"^sim/(.*config|evaluate/)"),
]

# What a folder of core may include beside itself and its own subfolders.
CORE = {
    "base": "",
    "image": "base",
    "hw": "base image",
    "runtime": "base",
    "surface": "base image",
    "metrology": "base image runtime surface",
    "stage": "base hw",
    "focus": "base image runtime surface",
    "scan": "base focus hw image runtime stage surface",
}

BEGIN, END = "<!-- folders: begin (tests/folder_graph.py --readme write) -->", "<!-- folders: end -->"



def includes():
    """(path, included) for every include of every source."""
    for top in TOPS:
        for folder, _, names in sorted(os.walk(os.path.join(ROOT, top))):
            for name in sorted(names):
                if not SOURCE.search(name):
                    continue
                path = os.path.relpath(os.path.join(folder, name), ROOT)
                with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                    text = file.read()
                for match in INCLUDE.finditer(text):
                    yield path, match.group(1)


def folder_edges(pairs):
    """{(folder, included folder): an example}"""
    edges = {}
    for path, included in pairs:
        a, b = os.path.dirname(path), os.path.dirname(included)
        if a != b and b.split("/")[0] in TOPS:
            edges.setdefault((a, b), f"{path} includes {included}")
    return edges


def layer_violations(pairs):
    found = []
    for path, included in pairs:
        for why, pattern, folder, may in FORBIDDEN:
            if path.startswith(folder + "/") and re.match(pattern, included) and not (may and re.match(may, path)):
                found.append(f"{path}: includes {included} ({why})")
        a, b = path.split("/"), included.split("/")
        if a[0] == b[0] == "core" and a[1] != b[1]:
            if a[1] not in CORE:
                found.append(f"{path}: tests/folder_graph.py has no rule for core/{a[1]}")
            elif b[1] not in CORE[a[1]].split():
                found.append(f"{path}: includes {included} (core/{a[1]} may include: {CORE[a[1]] or 'nothing'})")
    return found


def neighbours(edges):
    following = collections.defaultdict(set)
    for a, b in edges:
        following[a].add(b)
    return following


def reachable(following, start):
    seen, waiting = set(), list(following[start])
    while waiting:
        node = waiting.pop()
        if node not in seen:
            seen.add(node)
            waiting += following[node]
    return seen


def folder_circles(edges):
    """One text for every set of folders that all reach each other."""
    following = neighbours(edges)
    reach = {node: reachable(following, node) for node in sorted({n for edge in edges for n in edge})}
    circles, seen = [], set()
    for node in reach:
        if node in seen or node not in reach[node]:
            continue
        members = [other for other in reach[node] if node in reach[other]]
        seen.update(members)
        examples = [text for (a, b), text in sorted(edges.items()) if a in members and b in members]
        circles.append(f"{' <-> '.join(sorted(members))}: {'; '.join(examples)}")
    return circles


def drawing(edges):
    """Mermaid. An arrow that follows from others is left out, so that the order can be seen."""
    following = neighbours(edges)
    nodes = sorted({n for edge in edges for n in edge})

    def name(folder):
        return folder.replace("/", "_")

    lines = ["```mermaid", "flowchart TD"]
    for top in TOPS:
        lines.append(f"  subgraph {top}_all[{top}]")
        lines += [f"    {name(n)}[{n}]" for n in nodes if n.split("/")[0] == top]
        lines.append("  end")
    for a in nodes:
        for b in sorted(following[a]):
            if not any(b in reachable(following, other) for other in following[a] if other != b):
                lines.append(f"  {name(a)} --> {name(b)}")
    return "\n".join(lines + ["```"])


def readme(edges, write):
    path = os.path.join(ROOT, "README.md")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        sys.exit(f"README.md: needs the markers {BEGIN} and {END} once each")
    head, rest = text.split(BEGIN)
    tail = rest.split(END)[1]
    wanted = f"{head}{BEGIN}\n{drawing(edges)}\n{END}{tail}"
    if write:
        with open(path, "w", encoding="utf-8") as file:
            file.write(wanted)
    elif wanted != text:
        sys.exit("README.md: the drawing of the folders is not today's; run: tests/folder_graph.py --readme write")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--readme", choices=("check", "write"))
    options = parser.parse_args()
    pairs = list(includes())
    edges = folder_edges(pairs)
    if not edges:
        sys.exit(f"folder_graph.py: no sources under {ROOT}")
    if options.draw:
        print(drawing(edges))
        return
    if options.readme:
        readme(edges, options.readme == "write")
        return
    violations, circles = layer_violations(pairs), folder_circles(edges)
    if options.json:
        print(json.dumps({"layer_violations": violations, "folder_circles": circles}))
        return
    for text in violations:
        print(f"layer: {text}")
    for text in circles:
        print(f"circle: {text}")
    if violations or circles:
        sys.exit(1)
    print(f"{len(pairs)} includes, {len(edges)} pairs of folders: no layer crossed, no circle")


main()
