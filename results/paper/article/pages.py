"""The pages of all configs."""

from __future__ import annotations

from article.coefficient_items import DRAWS, coefficient_items
from article.dataset_items import dataset_items
from article.drawing import Panel, Series, write_figure, write_heat_maps
from article.equation_items import equation_items
from article.front import counts, errors, with_parts
from article.ledger import ledger, ledger_table
from article.run_figures import run_figures
from article.run_pages import (
    COLUMN_TITLE, ROW_TITLE, gain_curves, gain_matrix, heat_table, method_tables, threshold_maps,
)
from article.schematic_figures import schematic_figures
from article.segment_items import segment_items
from article.table_items import table_items
from article.tables import paper_tables
from article.trajectory_items import own_reading_items, trajectory_items

TABLES = """# Tables 1 to 4

Errors along one axis of the reference at the keyframes of the closed run, after a rigid fit; RPE over one keyframe; densely: at the stamps of the reference. The readings are explained in [README](README.md).

From{sources}.
"""
FIGURES = """# Figures 1 to 8

Truth red and thickest, ORB-SLAM2 green, ours blue and thinnest; curves are cut 0.3 m outside the reference. `text` is fitted in the reference's axes, `guarded` in axes along the chord of each window; all curves are drawn in the alignment of the raw run. Coefficients are those of y = +f(x), in the article's order and with its alpha(0,1) = 1.
"""
COLORS = ("#2ca02c", "#9467bd", "#8c564b", "#1f4fd6", "#17a2b8", "#d62728", "#ff7f0e", "#7f7f7f",
          "#000000", "#bcbd22")


def _sections(cells):
    return [
        ("Equations", "", equation_items(cells)),
        ("Datasets and thresholds", "", dataset_items(cells)),
        ("Tables 1 to 4",
         "Changes against the raw keyframes, with windows end to end; columns of [tables](tables.md).",
         table_items(cells)),
        ("Figures 5 to 8: which curve fits best",
         "One family over N, fitted to the reference from the same keyframes, in axes along the chord of"
         " each window; the error is that between the keyframes.",
         segment_items(cells)),
        ("Printed coefficients",
         f"The best of a search along the path of the reference, in its axes. {DRAWS:,} random curves, the"
         " printed coefficients with random signs and factors between 1/3 and 3, are searched in the same"
         " way: their share that comes as near is p.",
         coefficient_items(cells)),
        ("The complete trajectory", "The readings `text`.", trajectory_items(cells)),
    ]


OWN_READINGS = """# The same claims for our readings

`guarded` has guards that the article does not mention, and the natural spline fits no curve of the article: these are not statements of the article, but what its claims could rest on.

"""


def _figures(cells, folder):
    out = FIGURES
    for file, caption in schematic_figures(cells, folder):
        out += f"\n![{file}]({file})\n\n{caption}"
    for reading in ("text", "guarded"):
        out += f"\n## Reading `{reading}`\n"
        for file, caption in run_figures(cells, reading, folder / reading):
            out += f"\n![{reading}/{file}]({reading}/{file})\n\n{caption}"
    return out


def article_pages(configs, folder):
    """Tables, ledger and figures of all configs together, by name."""
    configs = [config for config in configs if config.is_tables]
    cells = [cell for config in configs for cell in config.cells]
    if not cells:
        return {}
    sources = "".join(f" {config.file.name}" for config in configs)
    sections = _sections(cells)
    return {
        "tables.md": TABLES.format(sources=sources) + paper_tables(cells),
        "ledger.md": "# The article, statement by statement\n\nFrom" + sources + ".\n\n" + ledger(sections),
        "figures.md": _figures(cells, folder),
        "own_readings.md": OWN_READINGS + ledger_table(own_reading_items(cells)),
    }


def front_page(configs, text):
    """The text of README.md with its tables."""
    cells = [cell for config in configs if config.is_tables for cell in config.cells]
    return with_parts(text, {"counts": counts(_sections(cells)), "errors": errors(cells)})


def _gain_figure(config, file):
    panels = []
    for run, curves in gain_curves(config.cells, config.baseline).items():
        series = [Series(method, COLORS[k % len(COLORS)], points)
                  for k, (method, points) in enumerate(curves.items())]
        labels = ("median keyframe interval [s]", "gain in dense 3-D ATE [%]", "")
        panels.append(Panel(series, run, same_scale=False, labels=labels))
    if panels:
        write_figure(file, panels, 3)


def run_page(config, folder):
    """Name and text of the page of a config without readings."""
    name = config.file.stem.removeprefix("paper_tables_")
    title = name.replace("_", " ")
    text = f"# {title[0].upper()}{title[1:]}\n\n{config.description()}\nFrom {config.file.name}.\n"
    figure = f"\n![{name}]({name}.svg)\n"
    if maps := threshold_maps(config):
        write_heat_maps(folder / f"{name}.svg", maps, ROW_TITLE, COLUMN_TITLE)
        text += figure + "".join(f"\n## {each.title}\n{heat_table(each)}" for each in maps)
    elif config.options.get("table", {}).get("rows") == ["sequence"]:
        _gain_figure(config, folder / f"{name}.svg")
        text += figure + gain_matrix(config.cells, config.baseline)
    else:
        text += method_tables(config)
    return name + ".md", text
