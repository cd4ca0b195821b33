#!/usr/bin/env python3
"""Compares the public surface with tests/surface.txt, so that it changes by decision only.

That is: names, options, defaults and choices of the catalogue; keys of configs; options of every command; installed
headers; names of the Python package; tables of a store; and what external programs receive and may answer.

Usage: surface.py LOOPBENCH [--update]; --update writes the file.
"""

import difflib
import json
import os
import pathlib
import re
import sqlite3
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILE = ROOT / "tests/surface.txt"


def catalogue(known):
    for subject in ("datasets", "methods", "metrics", "protocols"):
        for item in known[subject]:
            yield " ".join([subject[:-1], *(item[key] for key in ("name", "kind", "version") if key in item)])
            for o in item["options"]:
                yield f"  {o['name']}: {o['type']} {json.dumps(o['default'])} " + " | ".join(o.get("choices", ()))
    for place, keys in known["keys"].items():
        yield f"config {place}: " + " ".join(key["name"] for key in keys)


def commands(loopbench, *path):
    ask = lambda option: subprocess.run([loopbench, *path, option], capture_output=True, text=True, check=True).stdout
    text = ask("--help")
    if "--help-all" in text:
        text = ask("--help-all")
    yield " ".join(("command", *path))
    for names in re.findall(r"^  ((?:-[\w-]+(?:, )?)+)", text, re.M):
        yield "  " + names
    for child in re.findall(r"^  (\w+)", text.partition("\nSubcommands:\n")[2].partition("\n\n")[0], re.M):
        yield from commands(loopbench, *path, child)


def receive(kind, *arguments):
    """A program of the config below: stores the names of what it receives, and answers with an unknown key."""
    seen = ["variables " + " ".join(sorted(name for name in os.environ if name.startswith("LOOPBENCH_")))]
    if not arguments:
        magic, _, size, _ = struct.unpack("<8s3Q", sys.stdin.buffer.read(32))
        text = json.loads(sys.stdin.buffer.read(size))
        seen.append(magic.decode() + " " + " ".join(sorted(text)))
        seen += [f"{name}, {columns} columns" for name, _, columns in text["arrays"]]
    for file in sorted(pathlib.Path(arguments[0]).glob("*")) if arguments else ():
        seen.append(file.name + " " + " ".join(sorted(json.loads(file.read_text())) if file.suffix == ".json" else ()))
    pathlib.Path(os.environ["SURFACE"], kind).write_text("".join(f"\n  {line}" for line in seen))
    for result in arguments[1:]:
        if kind == "metric":
            pathlib.Path(result).write_text('{"scores": [{"unknown": 1}]}')
        else:
            pathlib.Path(result + ".json").write_text('{"unknown": 1}')


def sweep(loopbench, folder):
    """Tables of a store, and what the programs of a sweep receive; all fail."""
    me = f"{sys.executable} -B {pathlib.Path(__file__).resolve()} --receive"
    program = lambda name, kind, **more: {name: "command", "label": kind, **more}
    dataset = {"dataset": "command", "sequence": "c.yaml", "run": f"{me} dataset {{sequence}} {{trajectory}}"}
    config = {"datasets": [{"dataset": "simulated", "keyframes": 40}, dataset],
              "methods": ["raw", program("method", "method", run=f"{me} method {{problem}} {{result}}"),
                          program("method", "served", serve=f"{me} method,served")],
              "metrics": ["ate", program("metric", "metric", run=f"{me} metric {{evaluation}} {{result}}")]}
    pathlib.Path(folder, "c.yaml").write_text(json.dumps(config))
    clean = {name: value for name, value in os.environ.items() if not name.startswith("LOOPBENCH_")}
    subprocess.run([loopbench, "run", folder + "/c.yaml", "--out", folder, "--no-sandbox"], capture_output=True,
                   env=clean | {"SURFACE": folder})
    store = sqlite3.connect(folder + "/results.sqlite")
    yield "store " + str(*store.execute("PRAGMA user_version").fetchone())
    for (name,) in store.execute("SELECT name FROM sqlite_master WHERE type IN ('table', 'view') ORDER BY name"):
        for _, column, kind, *_ in store.execute(f"PRAGMA table_info({name})"):
            yield f"  {name}.{column} {kind}"
    for kind in ("dataset", "method", "method,served", "metric"):
        yield f"program of a {kind}" + pathlib.Path(folder, kind).read_text()
    for (why,) in store.execute("SELECT why FROM cell UNION SELECT why FROM score ORDER BY why"):
        yield from re.findall(".*found key 'unknown'.*", why)


def surface(loopbench):
    listed = subprocess.run([loopbench, "list", "--json"], capture_output=True, text=True, check=True).stdout
    headers = [path for folder in ("datasets", "methods", "metrics") for path in (ROOT / folder).rglob("*.hpp")]
    package = (ROOT / "harness/python/loopbench/__init__.py").read_text()
    yield from catalogue(json.loads(listed))
    yield from commands(loopbench)
    yield from sorted(f"header {path.relative_to(ROOT)}" for path in headers)
    yield "python " + " ".join(re.findall(r'^    "(\w+)",$', package, re.M))
    with tempfile.TemporaryDirectory() as folder:
        yield from sweep(loopbench, folder)


def main():
    if sys.argv[1] == "--receive":
        return receive(*sys.argv[2:])
    now = [line.rstrip() for text in surface(os.path.abspath(sys.argv[1])) for line in text.splitlines()]
    if "--update" in sys.argv:
        FILE.write_text("\n".join(now) + "\n")
    difference = list(difflib.unified_diff(FILE.read_text().splitlines(), now, "tests/surface.txt", "this build", n=0,
                                           lineterm=""))
    print(*difference, f"{len(now)} lines; --update writes a change that is intended", sep="\n")
    sys.exit(1 if difference else 0)


if __name__ == "__main__":
    main()
