"""Table and picture of results/methods/pose_graphs.md: graph_page.py STORE LOOPBENCH [DATA PICTURE.png]

STORE: results of configs/pose_graphs.yaml with --save-trajectories. The table goes to standard output.
DATA: the data folder; poses before the correction are read from its files.
"""

import csv
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SCORES = """
select method, label, relation, axis, score.rmse, cpu_seconds_median, peak_memory, keyframes,
       odometry + sequence.closures as edges, sequence
from cell join sequence using (sequence_key) left join score on score.cell = cell.id
where cell.status = 'ok' order by cell.position"""


def number(value):
    return f"{value:.6g}" if value is not None and value < 1e6 else f"{value:.2e}" if value else "-"


def gap(value):
    if value is None:
        return "-"
    return "optimal" if value < 1e-4 else "not proved" if value >= 100 else f"at most {value:.2g} %"


def print_table(store):
    graphs = {}
    for row in sqlite3.connect(store).execute(SCORES):
        method, label, relation, axis, value, seconds, memory, poses, edges, name = row
        graph = graphs.setdefault(name, {"poses": poses, "edges": edges})
        own = graph.setdefault(method, {"seconds": seconds, "memory": memory})
        if label == "cost" and axis == "all":
            own["cost"] = value
        if relation == "gap":
            own["gap " + axis] = value
    print("| graph | poses | edges | cost | from odometry | certificate | ms | MB |")
    print("| --- |" + " ---: |" * 4 + " --- |" + " ---: |" * 2)
    for name, graph in graphs.items():
        solved, odometry = graph["pose_graph"], graph.get("pose_graph from odometry", {})
        print(f"| {name} | {graph['poses']} | {graph['edges']} | {number(solved.get('cost'))}"
              f" | {number(odometry.get('cost'))} | {gap(solved.get('gap minimum'))}"
              f" | {1e3 * solved['seconds']:.3g} | {solved['memory'] / 2**20:.0f} |")


def positions_in(file):
    return np.loadtxt(file)[:, 1:4]


def draw(graphs, picture):
    """graphs: (name, positions before, positions after)."""
    figure, axes = plt.subplots(4, 5, figsize=(10, 8.4))
    for k, (name, *positions) in enumerate(graphs):
        plane = sorted(np.argsort(-np.var(positions[1], axis=0), kind="stable")[:2])
        for row, at in enumerate(positions):
            panel = axes[2 * (k // 5) + row, k % 5]
            panel.plot(at[:, plane[0]], at[:, plane[1]], lw=0.3, color=["#b35806", "#2166ac"][row])
            panel.set_aspect("equal", "datalim")
            panel.set_xticks([]), panel.set_yticks([])
            panel.set_title(name if row == 0 else "", fontsize=9)
    for row in range(4):
        axes[row, 0].set_ylabel(["before", "after"][row % 2], fontsize=9)
    figure.tight_layout(pad=0.4)
    figure.savefig(picture, dpi=110)


def pictured(store, program, data, folder):
    """The graphs of data/pose_graphs, with the information as in the file."""
    def loopbench(*arguments):
        subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL)

    loopbench("export", store, "--what", "trajectories", "-o", folder)
    for row in csv.DictReader(Path(folder, "index.csv").open()):
        graph = [*Path(data, "pose_graphs").glob(row["sequence"] + "*.g2o")]
        if row["method"] == "pose_graph" and graph:
            before = Path(folder, graph[0].stem + "-before.txt")
            loopbench("traj", "convert", graph[0], "-o", before)
            yield row["sequence"], positions_in(before), positions_in(Path(folder, row["file"]))


if __name__ == "__main__":
    store, program = Path(sys.argv[1]), sys.argv[2]
    print_table(store / "results.sqlite")
    if len(sys.argv) > 3:
        with tempfile.TemporaryDirectory() as folder:
            draw(pictured(store, program, sys.argv[3], folder), sys.argv[4])
