"""Tables from stores and from `compare`, and the parts of the pages that are made of them, as Markdown by name."""

from __future__ import annotations

import contextlib
import math
import re
import sqlite3
from collections import defaultdict
from statistics import median
from typing import NamedTuple

from article.verdicts import table

SMOOTHERS = ("tracked_frames", "cubic_spline", "gp_wnoa", "spline, quasi-keyframes", "smoother N4", "smoother M7",
             "smoother robust")
SHOWN_ROBUST = ("dual", "pose_graph_huber", "pose_graph_gnc_tls", "pose_graph_pcm", "consensus")
FALSE_CLOSURES = ("raw", "pose_graph", "pose_graph_huber", "pose_graph_cauchy", "pose_graph_dcs", "pose_graph_gnc_tls",
                  "pose_graph_pcm", "consensus")
CHOOSING = FALSE_CLOSURES[4:]
ROWS = """
select cell.id, cell.position, cell.sequence, repeat, method, cell.status, cpu_seconds_median as seconds,
  peak_memory as memory, group_name as grouped, sequence.closures as closures,
  odometry + sequence.closures as edges, label, relation, score.axis as axis, score.unit as unit, rmse
from cell join sequence using (sequence_key) left join score on score.cell = cell.id
where cell.position is not null order by cell.position, repeat, score.number"""
KEPT = """
select cell.sequence, value as kept, sequence.closures as closures
from cell join sequence using (sequence_key) join count on count.cell = cell.id
where cell.position is not null and method = 'pose_graph_pcm' and name = 'closures_consistent' order by cell.position"""


def rows_of(store, query=ROWS):
    with contextlib.closing(sqlite3.connect(f"file:{store / 'results.sqlite'}?mode=ro", uri=True)) as database:
        database.row_factory = sqlite3.Row
        return database.execute(query).fetchall()


class Table(NamedTuple):
    head: tuple
    lines: list

    def markdown(self, columns=None):
        """The first columns, by default all."""
        head, *lines = (row[:columns] for row in (self.head, *self.lines))
        return table(head, ("---", *["---:"] * (len(head) - 1)), *lines)


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def digits(value):
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def ratio_of(value):
    return f"{value:.3f}" if value < 10 else digits(value)


def ratio_text(row):
    """Typical ratio with its interval; without one if there are too few groups."""
    low, high = row["ratio_low"], row["ratio_high"]
    return ratio_of(float(row["ratio"])) + (f" [{ratio_of(float(low))}, {ratio_of(float(high))}]" if low else "")


def ates(rows):
    """ATE [m] by (sequence, repeat), then by method, and what is known of the sequences."""
    found, known = defaultdict(dict), {}
    for row in rows:
        if row["label"] == "ate" and row["unit"] == "m" and row["rmse"] is not None:
            found[row["sequence"], row["repeat"]][row["method"]] = row["rmse"]
            known[row["sequence"], row["repeat"]] = row
    return found, known


def chain_parts(program, store):
    """Parts of the page, and complete tables."""
    found, known = ates(rows_of(store))
    found = {run: each for run, each in found.items() if "dual" in each}
    methods = list(dict.fromkeys(m for each in found.values() for m in each))
    family = {run: run[0].rsplit(" ", 1)[0] for run in found}
    route = {run: known[run]["grouped"].removeprefix("group:") for run in found}

    def means(runs, method):
        return geometric_mean([found[run][method] / found[run]["dual"] for run in runs if method in found[run]])

    routes, others = sorted(set(route.values())), [m for m in methods if m != "dual"]
    lines = []
    for name in routes:
        runs = [run for run in found if route[run] == name]
        lines.append((name, str(len(runs)),
                      "-".join(map(str, sorted({f(known[r]["closures"] for r in runs) for f in (min, max)}))),
                      digits(geometric_mean([found[r]["dual"] for r in runs])),
                      str(sum(found[r]["dual"] > found[r].get("raw", math.inf) for r in runs)),
                      *(f"{means(runs, m):.2f}" for m in others)))
    by_route = Table(("route", "chains", "closures", "dual [m]", "dual above raw", *others), lines)
    compared, lines = program.compared(store, "dual"), []
    for method in others:
        row, ratios = compared[method], {r: e[method] / e["dual"] for r, e in found.items() if method in e}
        worst = max(ratios, key=ratios.get)
        of_route = {name: means([r for r in found if route[r] == name], method) for name in routes}
        low, high = (f(of_route, key=of_route.get) for f in (min, max))
        lines.append((method, ratio_text(row), f"{float(row['p']):.2g}" if row["p"] else "-",
                      f"{row['better']}/{row['worse']}/{row['equal']}",
                      f"{of_route[low]:.2f} ({low})", f"{of_route[high]:.2f} ({high})",
                      str(sum(ratio > 1.05 for ratio in ratios.values())), f"{ratios[worst]:.2f} ({worst[0]})"))
    correctors = Table(("method", "ratio to `dual`", "p", "routes", "lowest route", "highest route", "chains above 1.05",
                        "highest chain"), lines)
    parts = {"correctors": correctors.markdown(5),
             "chains": f"{len(found)} chains of {len({name.split(' (')[0] for name in family.values()})} odometers on"
                       f" {len(routes)} routes.\n"}
    kept = rows_of(store, KEPT)
    if kept:
        least = min(kept, key=lambda row: row["kept"] / row["closures"])
        parts["chains"] += (f"`pose_graph_pcm` rejects {sum(r['closures'] - r['kept'] for r in kept):.0f} of"
                             f" {sum(r['closures'] for r in kept)} closures here, the largest share on {least['sequence']}:"
                             f" {least['closures'] - least['kept']:.0f} of {least['closures']}.\n")
    return parts, {"correctors": correctors, "by_route": by_route}


def outlier_parts(program, store):
    """Parts of the page, and complete tables."""
    found, _ = ates(rows_of(store))
    shares = list(dict.fromkeys(re.search(r"share=(.*)\)", run[0])[1] for run in found))
    methods, columns = list(dict.fromkeys(m for each in found.values() for m in each)), []
    head = ["method"]
    for share in shares:
        runs = [each for run, each in found.items() if run[0].endswith(f"share={share})")]
        compared = program.compared(store, "pose_graph_pcm", rf"sequence~.*share={re.escape(share)}\)")
        columns.append(["; ".join((*((ratio_text(compared[m]),) if m != "pose_graph_pcm" else ()),
                                   str(sum(e.get(m, math.inf) > e["raw"] for e in runs)))) for m in methods])
        head.append(f"{100 * float(share):g} % false ({len(runs)} runs, {compared['raw']['groups']} routes)")
    lines = [(m, *(column[k] for column in columns)) for k, m in enumerate(methods)]
    # The page has ratios without intervals.
    shown = Table(("method", *(name.split(" false")[0] for name in head[1:])),
                  [[re.sub(r" \[.*\]", "", cell) for cell in line] for line in lines if line[0] in SHOWN_ROBUST])
    return {"outliers": shown.markdown()}, {"outliers": Table(head, lines)}


def share_of(sequence):
    """Share of false closures [%]."""
    return 100 * float(re.search(r"share=(.*)\)", sequence)[1])


def share_part(simulated, kitti):
    """Mean ATE [m] by the share of false closures."""
    lines = []
    for title, store, first in (("drive", simulated, "driving ("), ("KITTI 00", kitti, "true list (")):
        by_share = defaultdict(list)
        for (sequence, _), each in ates(rows_of(store))[0].items():
            if sequence.startswith(first):
                by_share[share_of(sequence)].append(each)
        for share, runs in sorted(by_share.items()):
            means = [sum(each[m] for each in runs) / len(runs) for m in FALSE_CLOSURES]
            lines.append((f"{title} {share:g} %", *(f"{mean:.3f}" if mean < 10 else digits(mean) for mean in means)))
    return Table(("false", *(m.replace("pose_graph_", "") for m in FALSE_CLOSURES)), lines).markdown()


def choice_part(*stores):
    """Mean shares [%] of false closures that were kept and of true ones that were dropped, by the share of false ones. Each
    store has a title and the first characters of its sequences."""
    lines = []
    for title, store, first in stores:
        found = defaultdict(lambda: defaultdict(list))
        for row in rows_of(store):
            if row["rmse"] is not None and row["label"].startswith("closures_") and row["sequence"].startswith(first):
                found[share_of(row["sequence"])][row["method"], row["label"]].append(row["rmse"])

        def mean(runs, method, name):
            values = runs[method, name]
            return f"{sum(values) / len(values):.1f}" if values else "-"

        for share, runs in sorted(found.items()):
            lines.append((f"{title} {share:g} %", *(f"{mean(runs, m, 'closures_kept_false')}; "
                                                    f"{mean(runs, m, 'closures_dropped_true')}" for m in CHOOSING)))
    return Table(("false", *(m.replace("pose_graph_", "") for m in CHOOSING)), lines).markdown()


def spacing_part(program, stores):
    columns, head = {}, ["method"]
    for title, store in stores.items():
        for value in ("0.3", "0.8", "1.6"):
            columns[title, value] = program.compared(store, "polyline", rf"sequence~.*value={re.escape(value)}\)")
            row = columns[title, value]["polyline"]
            head.append(f"{title} ({row['runs']}), {value} s")
    return Table(head, [(m, *(ratio_text(c[m]) if m in c else "" for c in columns.values())) for m in SMOOTHERS]).markdown()


def graph_parts(store):
    """Parts of the page, and complete tables."""
    graphs = defaultdict(dict)
    for row in rows_of(store):
        graph = graphs[row["sequence"]]
        graph["edges"] = row["edges"]
        if row["label"] == "cost" and row["axis"] == "all":
            graph[row["method"]] = row["rmse"]
        if row["relation"] == "gap" and row["axis"] == "minimum" and row["method"] == "pose_graph":
            graph["gap"] = row["rmse"]
    ratios = {name: graph["pose_graph from odometry"] / graph["pose_graph"] for name, graph in graphs.items()}
    proved = {name: graph.get("gap", 100) < 1e-4 for name, graph in graphs.items()}
    complete = Table(("graph", "edges", "cost from odometry over that of the chordal start", "certificate"),
                     [(name, str(graph["edges"]), f"{ratios[name]:.4g}", "optimal" if proved[name] else "not proved")
                      for name, graph in graphs.items()])
    same = sum(abs(ratio - 1) <= 1e-6 for ratio in ratios.values())
    text = (f"{len(graphs)} graphs with up to {max(graph['edges'] for graph in graphs.values())} edges: on"
            f" {sum(proved.values())} the nearest minimum of the isotropic cost is proved to be the global one.\nFrom odometry"
            f" the cost is that of the chordal start on {same}; elsewhere it is {min(ratios.values()):.4g} to"
            f" {max(ratios.values()):.4g} times as large.\n")
    return {"graphs": text}, {"graphs": complete}


def cost_table(stores):
    """Over all sweeps, by method."""
    cells = [row for store in stores for row in {row["id"]: row for row in rows_of(store)}.values()]
    cells = [(re.sub(r"^smoother ([NM])\d", r"smoothers \1", row["method"]), row) for row in cells]
    lines = []
    for method in dict.fromkeys(method for method, _ in cells):
        own = [row for name, row in cells if name == method]
        good = [row for row in own if row["status"] == "ok"]
        seconds = [row["seconds"] for row in good] or [math.nan]
        lines.append((method, str(len(own)), digits(1e3 * median(seconds)), digits(1e3 * max(seconds)),
                      digits(max((r["memory"] for r in good), default=math.nan) / 2**20)))
    return Table(("method", "cells", "median [ms]", "maximum [ms]", "memory [MiB]"), lines)


def status_text(stores):
    found = [row["status"] for store in stores for row in {row["id"]: row for row in rows_of(store)}.values()]
    declined = found.count("declined")
    return f"{len(found)} cells: {declined} declined, {len(found) - declined - found.count('ok')} failed.\n"
