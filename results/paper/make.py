#!/usr/bin/python3
"""Makes the pages and figures of this folder. Needs the compiled Python package, PyYAML, matplotlib
and the plugin of plugin/; README.md has the commands."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILD = HERE.parents[1] / "build" / "release"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("configs", nargs="*", type=Path, default=sorted(HERE.glob("configs/paper_tables_*.yaml")),
                        help="configs, by default all of configs/")
    parser.add_argument("--build", type=Path, default=BUILD, help="build folder of loopbench")
    parser.add_argument("--data", default=os.environ.get("LOOPBENCH_DATA", ""),
                        help="folder with real datasets")
    parser.add_argument("--out", type=Path, default=HERE, help="folder for pages and figures")
    parser.add_argument("-j", "--jobs", type=int, default=2, help="number of workers")
    given = parser.parse_args()
    sys.path[:0] = [str(HERE), str(given.build / "python")]
    if given.data:
        os.environ["LOOPBENCH_DATA"] = str(Path(given.data).resolve())

    from article.pages import article_pages, front_page, run_page
    from article.program import Program
    from article.runs import run_config

    build = given.build.resolve()
    program = Program(str(build / "loopbench"), str(build / "paper_readings.so"), given.data,
                      given.jobs)
    given.out.mkdir(parents=True, exist_ok=True)
    configs = []
    for file in given.configs:
        try:
            configs.append(run_config(file.resolve(), program))
        except RuntimeError as reason:
            print(f"{file.name}: skipped: {reason}", file=sys.stderr, flush=True)
            continue
        print(f"{file.name}: {len(configs[-1].cells)} cells", file=sys.stderr, flush=True)
    pages = article_pages(configs, given.out)
    if len(configs) == len(list(HERE.glob("configs/paper_tables_*.yaml"))):
        pages["README.md"] = front_page(configs, (HERE / "README.md").read_text(encoding="utf-8"))
    pages.update(run_page(config, given.out) for config in configs if not config.is_tables)
    for name, text in pages.items():
        (given.out / name).write_text(text, encoding="utf-8")
        print(given.out / name)


if __name__ == "__main__":
    main()
