"""Draws the figures of a JSON document, read from standard input or a file; started by the program.

    python3 render.py [FILE]

The document is a list of data as in `draw`, each with figures: [{files, panels, columns, size,
font}]. Files that end in .svg, .pdf or .png are written as such; .json is a document with the data
of the figure. Standard output is a JSON list of SVG texts: the figures without files. Exit code 2:
a text on standard output describes the failure.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from typing import Any

_DEBIAN = "/usr/bin/python3"


def _check_matplotlib() -> None:
    """Starts Debian's interpreter instead of one without matplotlib."""
    try:
        import matplotlib  # noqa: F401
        return
    except ImportError:
        pass
    is_debian = os.path.realpath(sys.executable) == os.path.realpath(_DEBIAN)
    if not is_debian and os.path.exists(_DEBIAN):
        os.execv(_DEBIAN, [_DEBIAN, *sys.argv])
    print("matplotlib is not installed (package python3-matplotlib)", end="")
    sys.exit(2)


def _draw(data: dict[str, Any], wanted: dict[str, Any]) -> str | None:
    from loopbench import draw

    files = wanted.get("files", [])
    drawn = [each for each in files if not each.endswith(".json")]
    fig = None
    if drawn or not files:
        fig = draw.figure(data, wanted["panels"], wanted["columns"], wanted["size"], wanted["font"])
    for file in files:
        if fig is not None and file in drawn:
            draw.save(fig, file)
        else:
            own = {**data, "figures": [{**wanted, "files": [file[:-5] + ".svg"]}]}
            draw.replace_file(file, json.dumps([own]).encode())
    return None if files or fig is None else draw.image(fig, "svg").decode()


def _draw_share(jobs: list[Any], first: int, step: int) -> dict[str, Any]:
    try:
        return {"drawn": {i: _draw(*jobs[i]) for i in range(first, len(jobs), step)}}
    except OSError as error:
        return {"failed": f"{error.filename}: cannot be written: {error.strerror}"}


def _draw_all(jobs: list[Any]) -> list[dict[str, Any]]:
    """On all cores, in forks of this process, which has loaded matplotlib and the data."""
    workers = min(len(os.sched_getaffinity(0)), len(jobs))
    if workers < 2:
        return [_draw_share(jobs, 0, 1)]
    from loopbench import draw  # noqa: F401

    ends = []
    for worker in range(workers):
        read_end, write_end = os.pipe()
        if os.fork() == 0:
            try:
                with open(write_end, "w") as out:
                    json.dump(_draw_share(jobs, worker, workers), out)
            except BaseException:
                traceback.print_exc()
            os._exit(0)
        os.close(write_end)
        ends.append(read_end)
    shares = [json.load(open(end)) for end in ends]
    for _ in ends:
        os.wait()
    return shares


def main() -> None:
    sys.dont_write_bytecode = True  # the folder may be a package's
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    _check_matplotlib()
    with open(sys.argv[1]) if len(sys.argv) > 1 else sys.stdin as document:
        jobs = [(data, wanted) for data in json.load(document) for wanted in data["figures"]]
    shares = _draw_all(jobs)
    for share in shares:
        if "failed" in share:
            print(share["failed"], end="")
            sys.exit(2)
    drawn = {int(i): svg for share in shares for i, svg in share["drawn"].items() if svg}
    json.dump([drawn[i] for i in sorted(drawn)], sys.stdout)


if __name__ == "__main__":
    main()
