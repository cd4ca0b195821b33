#!/usr/bin/env python3
"""Draws the folders of the product, their lines of code and who includes whom, as SVG.

    tests/house_map.py > tests/house_map.svg    draw
    tests/house_map.py --check                  fail if folders or arrows differ from tests/house_map.svg

An arrow points from a folder to one that it includes. Arrows that follow from two others are omitted, and so are
lines of code in the check: they change with every commit.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / "tests/house_map.svg"
PARTS = ["datasets", "methods", "metrics", "harness"]
OF_THEIR_OWN = ["datasets/core"]
WINGS = ["sweep", "answers"]
COLOURS = {"datasets": "#cfe3f5", "methods": "#fbe0c3", "metrics": "#d9efd3", "harness": "#e6e0f2"}
WIDTH, BOX_WIDTH, BOX_HEIGHT, ROW_HEIGHT = 960, 130, 44, 78


def folder_of(path):
    """The box of a file, for example `harness/sweep/run` or `datasets`."""
    for folder in OF_THEIR_OWN:
        if path.startswith(folder + "/"):
            return folder
    part, *rest = path.split("/")
    return "/".join([part, *rest[:2 if rest[0] in WINGS else 1]]) if part == "harness" else part


def read_tree():
    """Lines per folder, and for each folder the set of folders that it includes."""
    lines = collections.Counter()
    included = collections.defaultdict(set)
    for part in PARTS:
        for file in sorted((ROOT / part).rglob("*.[ch]pp")):
            folder = folder_of(file.relative_to(ROOT).as_posix())
            text = file.read_text()
            lines[folder] += text.count("\n")
            names = re.findall(r'^#include "((?:datasets|methods|metrics|harness)/[^"]+)"', text, re.M)
            included[folder] |= {folder_of(name) for name in names} - {folder}
    return lines, included


def reachable(included, folder):
    below = set()
    for other in included[folder]:
        below |= {other} | reachable(included, other)
    return below


def direct_arrows(included):
    """Pairs (from, to) without those that follow from two others."""
    below = {folder: reachable(included, folder) for folder in list(included)}
    return sorted((a, b) for a in included for b in included[a]
                  if not any(b in below[c] for c in included[a] if c != b))


def positions(lines, arrows):
    """Centre of each box: a row above all that it includes, near the boxes that it includes."""
    rows = {}

    def row(folder):
        if folder not in rows:
            rows[folder] = max((row(b) + 1 for a, b in arrows if a == folder), default=0)
        return rows[folder]

    members = collections.defaultdict(list)
    for folder in lines:
        members[row(folder)].append(folder)
    at = {}
    for level in sorted(members):
        wish = {f: [at[b][0] for a, b in arrows if a == f] for f in members[level]}
        wish = {f: sum(x) / len(x) if x else WIDTH / 2 for f, x in wish.items()}
        ordered = sorted(members[level], key=lambda f: (wish[f], f))
        for i, folder in enumerate(ordered):
            at[folder] = (WIDTH * (i + 0.5) / len(ordered), (max(members) - level + 0.5) * ROW_HEIGHT)
    return at


def draw(lines, arrows):
    at = positions(lines, arrows)
    height = max(y for _, y in at.values()) + ROW_HEIGHT / 2
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}" font-family="sans-serif" '
           'font-size="13" text-anchor="middle">',
           '<defs><marker id="head" markerWidth="9" markerHeight="9" refX="8" refY="4" orient="auto">'
           '<path d="M0,0 L9,4 L0,8 z" fill="#555"/></marker></defs>',
           '<rect width="100%" height="100%" fill="white"/>']
    for a, b in arrows:
        (x, y), (u, v) = at[a], at[b]
        if v - y < 1.5 * ROW_HEIGHT:
            start, bend = (x, y + BOX_HEIGHT / 2), x
        else:  # past the boxes between, from the side of the box
            side = 1 if u > x else -1
            start, bend = (x + side * BOX_WIDTH / 2, y), x + side * (BOX_WIDTH / 2 + 70)
        v -= BOX_HEIGHT / 2
        middle = (start[1] + v) / 2
        out.append(f'<path data-arrow="{a} {b}" d="M{start[0]:.0f},{start[1]:.0f} C{bend:.0f},{middle:.0f} '
                   f'{bend if u == x else u:.0f},{middle:.0f} {u:.0f},{v:.0f}" fill="none" stroke="#555" marker-end="url(#head)"/>')
    for folder, (x, y) in at.items():
        out.append(f'<rect data-folder="{folder}" x="{x - BOX_WIDTH / 2:.0f}" y="{y - BOX_HEIGHT / 2:.0f}" '
                   f'width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" fill="{COLOURS[folder.split("/")[0]]}" stroke="#555"/>'
                   f'<text x="{x:.0f}" y="{y - 3:.0f}">{folder}</text>'
                   f'<text x="{x:.0f}" y="{y + 14:.0f}" fill="#444">{lines[folder]:,} lines</text>')
    return "\n".join(out) + "\n</svg>\n"


def main():
    lines, included = read_tree()
    picture = draw(lines, direct_arrows(included))
    if sys.argv[1:] != ["--check"]:
        sys.stdout.write(picture)
        return
    found, expected = (set(re.findall(r'data-(?:arrow|folder)="[^"]+"', text)) for text in (PICTURE.read_text(), picture))
    if found != expected:
        sys.exit(f"tests/house_map.svg differs from the tree in {sorted(found ^ expected)}: "
                 "run tests/house_map.py > tests/house_map.svg")


main()
