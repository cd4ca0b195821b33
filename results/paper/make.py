#!/usr/bin/python3
"""Makes the tables and figures of this folder, and the pages of the sweeps in results/methods/configs.
Needs the compiled Python package, PyYAML, matplotlib and what plugin/ builds; README.md has the
commands."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(RESULTS), str(RESULTS / "paper"), str(RESULTS / "methods")]

from pages import with_parts  # noqa: E402


def article_pages(configs, out, readme=""):
    """Pages on the article by path below `out`, where their figures are written, and the front page
    with its counts."""
    from article import judge_complete, judge_curves, judge_segments  # noqa: F401  registers judges
    from article.cells import Results
    from article.figures import write_figures
    from article.judge_tables import error_table, paper_tables
    from article.statements import ARTICLE, counts, items, judged_sections, ledger, totals

    results = Results([cell for config in configs for cell in config.cells])
    sections = judged_sections(results)
    captions = write_figures(results, out / "paper")
    figures = "".join(f"\n![figure{k}.svg](figure{k}.svg)\n\n**Figure {k}.** {captions[k]}"
                      for k in sorted(captions))
    own = [("Our own readings, not of the article", list(items(ARTICLE["own_readings"], results)))]
    pages = {"paper/tables.csv": paper_tables(results), "paper/figures.md": ARTICLE["figures"]["page"] + figures,
             "paper/errors.csv": error_table(results), "paper/ledger.csv": ledger(sections + own),
             "paper/counts.csv": counts(sections)}
    return pages, with_parts(readme, {"totals": totals(sections)})


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", metavar="NAMES", nargs="+", help="configs by name")
    parser.add_argument("--build", type=Path, default=RESULTS.parent / "build" / "release",
                        help="build folder of loopbench")
    parser.add_argument("--data", default=os.environ.get("LOOPBENCH_DATA", ""),
                        help="folder with real datasets")
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder for paper/ and methods/")
    parser.add_argument("-j", "--jobs", type=int, default=2, help="number of workers")
    given = parser.parse_args()
    build = given.build.resolve()
    sys.path.insert(0, str(build / "python"))
    if given.data:
        given.data = os.environ["LOOPBENCH_DATA"] = str(Path(given.data).resolve())

    from article.runs import RUNS, Program, run_config
    from sweep_pages import page_of, sweep_page

    program = Program(str(build / "loopbench"), str(build / "paper_readings.so"), given.data,
                      given.jobs)
    names = {name: name for name in RUNS["configs"]}
    for file in sorted(RESULTS.glob("methods/configs/*")):
        if not file.stem.startswith("ablation"):  # their page is written by hand
            names[file.stem] = file
    pages, article, sweeps = {}, [], {}
    for name, source in names.items():
        if given.only and name not in given.only:
            continue
        try:
            config = run_config(source, program)
        except RuntimeError as reason:
            print(f"{name}: skipped: {reason}", file=sys.stderr, flush=True)
            continue
        print(f"{name}: {len(config.cells)} cells", file=sys.stderr, flush=True)
        if name in RUNS["configs"]:
            article.append(config)
        else:
            sweeps[name] = config
    for page in dict.fromkeys(map(page_of, sweeps)):
        parts = [name for name in names if page_of(name) == page]
        if all(name in sweeps for name in parts):  # otherwise it would lose the columns of the others
            pages[f"methods/{page}.md"] = sweep_page([sweeps[name] for name in parts], given.out / "methods")
    if article:
        readme = (RESULTS / "paper" / "README.md").read_text(encoding="utf-8")
        found, front = article_pages(article, given.out, readme)
        pages.update(found)
        if len(article) == len(RUNS["configs"]):
            pages["paper/README.md"] = front
    for name, text in pages.items():
        (given.out / name).parent.mkdir(parents=True, exist_ok=True)
        (given.out / name).write_text(text, encoding="utf-8")
        print(given.out / name)


if __name__ == "__main__":
    main()
