"""Draws the figures of a JSON document, read from standard input or a file; started by the program.

    python3 render.py [FILE]

The document is a list of data as in `draw`, each with figures: [{files, panels, script, and
arguments of draw.figure}]. A script is written beside the files, with the data of the figure.
Exit code 2: a text on standard output describes the failure.
"""

from __future__ import annotations

import json
import logging
import os
import sys
import traceback
from pathlib import Path
from typing import Any

_DEBIAN = "/usr/bin/python3"
_OPTIONS = ("columns", "size", "font", "style", "plane")  # of draw.figure


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


_SCRIPT = '''"""Draws {name} from {name}.json; needs matplotlib. Edit and run it."""

import json
import sys
from pathlib import Path

sys.path.append({package!r})
from loopbench import draw

here = Path(__file__).parent
data = json.loads((here / "{name}.json").read_text())
# Names and texts: data["title"], data["note"], data["curves"][1]["name"]
figure = draw.figure(
    data,
    {arguments},
)
# Panels are axes of matplotlib: figure.axes[0].set_ylim(0.0, 0.1)
for suffix in {suffixes}:
    draw.save(figure, here / f"{name}.{{suffix}}")
'''


def _write_script(data: dict[str, Any], panels: Any, options: dict[str, Any], files: Any) -> None:
    from loopbench import draw

    stem = Path(files[0]).with_suffix("")
    options = {key: value for key, value in options.items() if value not in ([], None)}
    values = {
        "name": stem.name,
        "package": str(Path(__file__).resolve().parents[1]),
        "arguments": ",\n    ".join([repr(panels), *(f"{k}={v!r}" for k, v in options.items())]),
        "suffixes": [Path(file).suffix[1:] for file in files],
    }
    draw.replace_file(f"{stem}.json", json.dumps(data).encode())
    draw.replace_file(f"{stem}.py", _SCRIPT.format(**values).encode())


def _draw(data: dict[str, Any], wanted: dict[str, Any]) -> None:
    from loopbench import draw

    options = {key: value for key, value in wanted.items() if key in _OPTIONS}
    if "style" in options:
        is_file = os.path.isfile
        options["style"] = [os.path.abspath(s) if is_file(s) else s for s in options["style"]]
    fig = draw.figure(data, wanted["panels"], **options)
    files = wanted["files"]
    for file in files:
        draw.save(fig, file)
    if wanted.get("script"):
        own = {key: value for key, value in data.items() if key != "figures"}
        _write_script(own, wanted["panels"], options, files)


def _draw_share(jobs: list[Any], first: int, step: int) -> str:
    """Returns why it failed, or an empty text."""
    try:
        for job in jobs[first::step]:
            _draw(*job)
    except OSError as error:
        if error.filename is None:  # a style sheet that matplotlib does not find
            return str(error)
        return f"{error.filename}: cannot be written: {error.strerror}"
    return ""


def _draw_all(jobs: list[Any]) -> list[str]:
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
    seen: set[str] = set()
    once = lambda record: not (record.msg in seen or seen.add(record.msg))  # noqa: E731
    logging.getLogger("matplotlib.font_manager").addFilter(once)
    with open(sys.argv[1]) if len(sys.argv) > 1 else sys.stdin as document:
        jobs = [(data, wanted) for data in json.load(document) for wanted in data["figures"]]
    for failure in filter(None, _draw_all(jobs)):
        print(failure, end="")
        sys.exit(2)


if __name__ == "__main__":
    main()
