#!/usr/bin/env python3
"""Applies the recipes of CONTRIBUTING.md, builds the program and uses their results: recipes_test.py SOURCE BUILD.

Each patch of tests/recipes is applied to copies of the files that it changes. The copies are compiled and linked before
the libraries of the build, so that nothing else has to be compiled again.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

source, build = (os.path.abspath(folder) for folder in sys.argv[1:])
recipes = sorted(Path(source, "tests/recipes").glob("*.patch"))


def apply_to(copy):
    """Writes the changed files below `copy`; returns their names."""
    text = "".join(recipe.read_text() for recipe in recipes)
    for name in re.findall(r"^--- a/(.+)", text, re.M):
        os.makedirs(os.path.join(copy, os.path.dirname(name)), exist_ok=True)
        shutil.copy(os.path.join(source, name), os.path.join(copy, name))
    # The names are relative to `copy`, also if a folder above it is a repository.
    run("git", "apply", *recipes, cwd=copy, env=os.environ | {"GIT_CEILING_DIRECTORIES": os.path.dirname(copy)})
    return re.findall(r"^\+\+\+ b/(.+)", text, re.M)


def compile_flags():
    """Compiler and include folders of the program's own source."""
    for entry in json.load(open(os.path.join(build, "compile_commands.json"))):
        words = shlex.split(entry["command"])
        if " CMakeFiles/loopbench.dir/" in entry["command"]:
            compiler = next(word for word in words if re.search(r"(clang\+\+|g\+\+|c\+\+)[-\d.]*$", word))
            kept = [word for word in words if re.match(r"-(I|D|std=|f)", word)]
            system = [word for pair in zip(words, words[1:]) if pair[0] == "-isystem" for word in pair]
            return compiler, kept + system
    sys.exit("no compile command of the program")


def link_command(objects, output):
    """The program's link command with the objects before its libraries."""
    commands = subprocess.run(["ninja", "-C", build, "-t", "commands", "loopbench"], check=True, capture_output=True, text=True)
    words = commands.stdout.strip().splitlines()[-1].split()
    words = words[words.index("&&") + 1:] if "&&" in words else words
    words = words[:words.index("&&")] if "&&" in words else words
    words[words.index("-o") + 1] = output
    first = next(i for i, word in enumerate(words) if word.endswith(".o"))
    return words[:first] + objects + ["-Wl,--allow-multiple-definition"] + words[first:]


def run(*words, **where):
    done = subprocess.run(words, capture_output=True, text=True, **where)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def expect(text, part):
    if part not in text:
        sys.exit(f"expected {part!r} in\n{text}")


page = Path(source, "CONTRIBUTING.md").read_text()
for recipe in recipes:
    expect(page, f"tests/recipes/{recipe.name}")
with tempfile.TemporaryDirectory() as copy:
    files = apply_to(copy)
    compiler, flags = compile_flags()

    def compile_one(name):
        output = os.path.join(copy, name.replace("/", "_") + ".o")
        run(compiler, f"-I{copy}", f"-I{source}", *flags, "-O0", "-c", os.path.join(copy, name), "-o", output)
        return output

    with ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(compile_one, [name for name in files if name.endswith(".cpp")]))
    built = os.path.join(copy, "loopbench")
    done = subprocess.run(link_command(objects, built), cwd=build, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)

    planar = os.path.join(copy, "planar.txt")
    with open(planar, "w") as out:
        out.write("0 0 0 0 0\n1 3 4 0 1.5\n2 6 0 0 3\n")
    config = os.path.join(copy, "circle.yaml")
    with open(config, "w") as out:
        out.write("datasets: [circle]\nmethods: [raw, half_way]\nmetrics: [height_error]\nprotocol: strict\n")
    expect(run(built, "length", planar), "10.000")
    expect(run(built, "list", "half_way"), "half way")
    expect(run(built, "eval", planar, planar, "--metric", "height_error"), "height")
    # A reader has the options of all readers.
    messy, times = os.path.join(copy, "messy.txt"), os.path.join(copy, "times.txt")
    with open(messy, "w") as out:
        out.write("2 6 0 0 3\n0 0 0 0 0\n1 3 4 0 1.5\n1 9 9 0 1.5\n1.5 nan 0 0 0\n")
    with open(times, "w") as out:
        out.write("10.5\n11.5\n12.5\n")
    options = ["--sort", "--drop-invalid", "--repeats", "keep_first"]
    expect(run(built, "eval", planar, messy, *options), "3 of 3 (100.0 %)")
    expect(run(built, "traj", "info", planar, "--times", times), "10.500000 to 12.500000")
    run(built, "run", config, "--out", os.path.join(copy, "results"), "--jobs", "1")
    rows = run(built, "export", os.path.join(copy, "results"), "--what", "rows", "-o", "-")
    for part in ("half_way", "height_error", "circle", "strict"):
        expect(rows, part)
    print(f"{len(recipes)} recipes, {len(files)} files: built and used")
