"""Runs a config with loopbench and reads its results."""

from __future__ import annotations

import contextlib
import re
import sqlite3
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

import loopbench
from article.cells import DRAW, DRAWN, ORB, REAL_STAMPS, Cell, Config
from article.statements import SEQUENCES

RUNS = yaml.safe_load(Path(__file__).with_name("runs.yaml").read_text(encoding="utf-8"))

DRAWS = 3  #: random draws of real keyframes
#: The number of keyframes of the article, a run whose keyframes ORB-SLAM2 chose, and the closed
#: run, which has poses at their stamps. The keyframes of the article are not public: its number of
#: them, resampled, is one stand-in, these are another.
REAL = {
    "fr1_room": (180, "tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt",
                 "tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run0.txt"),
    "fr3_office": (204, "tum_rgbd/fr3_office/orbslam2_mono_open_keyframes.txt",
                   "tum_rgbd/fr3_office/orbslam2_rgbd_closed_frames_run0.txt"),
}


def config_text(name):
    """The config of an entry of runs.yaml."""
    each = RUNS["configs"][name]
    sequence, align = each["sequence"], each.get("align", "se3")
    limits, folder = SEQUENCES[sequence], f"tum_rgbd/{sequence}/"
    thresholds = {"turn_max": limits["turn_max"],
                  "speed_band": limits["speed_band"] if align == "se3" else "none"}
    datasets = [{"dataset": "trajectory", "label": f"{sequence} {run}",
                 "reference": folder + "groundtruth.txt",
                 **{key: folder + value if isinstance(value, str) else value
                    for key, value in files.items()}} for run, files in each["runs"].items()]
    methods = [{"method": "raw", "label": ORB},
               {"method": "cubic_spline", "label": "natural spline"}]
    for reading, given in RUNS["readings"].items():
        options = {key: value for key, value in given.items() if key != "curves"}
        if "reference_align" in options:
            options["reference_align"] = align
        methods += [{**options, "label": f"{reading} {curve}", **windows, **thresholds}
                    for curve, windows in RUNS["curves"].items()
                    if re.fullmatch(given["curves"], curve)]
    rpe = {"metric": "rpe", "label": "rpe", "frame": "world"}  # per axis in world axes
    return yaml.safe_dump({
        "datasets": datasets, "methods": methods, "metrics": ["ate", "axis_error", rpe],
        "protocol": {"align": align}, "baseline": ORB}, sort_keys=False)


@dataclass
class Program:
    """The program with the plugin; `program("export", store)` returns its standard output."""

    file: str
    plugin: str
    data: str = ""
    jobs: int = 2

    def __call__(self, *words):
        done = subprocess.run([self.file, *map(str, words)], capture_output=True, text=True)
        if done.returncode not in (0, 1):  # 1: cells failed, which their rows say
            raise RuntimeError(f"{self.file} {words[0]}: {done.stderr.strip()}")
        return done.stdout

    def run(self, config, out, *options):
        data = ("--data", self.data) if self.data else ()
        self("run", config, "--out", out, "-j", self.jobs, "--plugin", self.plugin, *data, *options)


def _cells(store):
    database = sqlite3.connect(f"file:{store / 'results.sqlite'}?mode=ro", uri=True)
    with contextlib.closing(database):
        notes = database.execute("SELECT cell.sequence, cell.method, text FROM note JOIN cell ON"
                                 " note.cell = cell.id ORDER BY cell, number").fetchall()
    cells = {}
    for row in loopbench.rows(store):
        labels = row["sequence"], row["method"]
        if labels not in cells:
            status = "ok" if row["metric"] else row["cell_status"]  # an incomplete cell has scores
            cells[labels] = Cell(*labels, status, row["cell_why"], row["seconds"])
        if row["status"] == "ok":
            key = row["label"], row["axis"], row["times"], row["relation"]
            cells[labels].scores.setdefault(key, row)
    for *labels, text in notes:
        if tuple(labels) in cells:
            cells[tuple(labels)].notes.append(text)
    return list(cells.values())


def _trajectories(folder):
    """Rows of saved trajectories by labels of sequence and method, and times."""
    out = {}
    for file in folder.glob("*.txt"):
        lines = file.read_text(encoding="utf-8").splitlines()
        head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
        if "sequence" not in head:  # a reference
            continue
        rows = " ".join(line for line in lines if line[0] != "#").split()
        out[head["sequence"], head["method"], head["times"]] = np.array(rows, float).reshape(-1, 8)
    return out


def _evaluated(problem, reference, estimate):
    """Poses of the reference at the stamps of the estimate outside tracking gaps, and those."""
    tracked = np.sort(np.append(problem.keyframes[:, 0], problem.frames[:, 0]))
    kept = np.ones(len(estimate), bool)
    for begin, end in loopbench.tracking_gaps(reference, tracked):
        kept &= (estimate[:, 0] <= begin) | (estimate[:, 0] >= end)
    return reference[np.isin(reference[:, 0], estimate[kept, 0])], estimate[kept]


def _add_trajectories(config, saved):
    """Sets keyframes of all runs, and dense trajectories of what is drawn."""
    entries = {entry["label"]: entry for entry in config.options["datasets"]}
    loaded, how = {}, config.options.get("protocol", {}).get("align", "se3")
    for cell in config.cells:
        if cell.status != "ok":
            continue
        cell.keyframes = saved.get((cell.dataset, config.baseline, "keyframes"))
        estimate = saved.get((cell.dataset, cell.method, "dense"))
        if config.baseline != ORB or estimate is None:
            continue
        if cell.dataset not in loaded:
            loaded[cell.dataset] = loopbench.load(**entries[cell.dataset])
        cell.reference, cell.raw_estimate = _evaluated(*loaded[cell.dataset], estimate)
        cell.alignment = loopbench.align(cell.reference, cell.raw_estimate, how)
        cell.keyframes = cell.alignment.apply(cell.keyframes)


def _run(file, program):
    """Runs every cell, then those again whose trajectories are needed: the baseline, and for the
    article's own tables what is drawn."""
    options = yaml.safe_load(file.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as work:
        store, again, saved = (Path(work) / name for name in ("all", "again", "saved"))
        program.run(file, store)
        config = Config(file, options, _cells(store))
        wanted = DRAWN if config.baseline == ORB else config.baseline
        program.run(file, again, "--save-trajectories", f"--only= / ({wanted})$")
        program("export", again, "--what", "trajectories", "-o", saved)
        with contextlib.chdir(file.parent):
            _add_trajectories(config, _trajectories(saved))
    return config


def _chosen(run, stamps):
    """The lines of a TUM file nearest to the stamps, within 10 ms."""
    lines = [line for line in run.read_text().splitlines() if line and line[0] != "#"]
    own = np.array([float(line.split()[0]) for line in lines])
    nearest = np.abs(own[:, None] - stamps).argmin(0)
    kept = np.unique(nearest[np.abs(own[nearest] - stamps) < 0.01])
    return "".join(lines[i] + "\n" for i in kept)


def _at_real_stamps(options, data, folder):
    """Datasets of the closed runs of a config at stamps where ORB-SLAM2 chose keyframes: all of
    them, and random draws of as many as the article has."""
    out = []
    for sequence, (count, keyframes, run) in REAL.items():
        closed = next((d for d in options["datasets"] if d["label"] == f"{sequence} closed"), {})
        if closed.get("estimate") != run:
            continue
        random, stamps = np.random.default_rng(1), np.loadtxt(data / keyframes)[:, 0]
        choices = {REAL_STAMPS: stamps}
        for k in range(DRAWS):
            drawn = random.choice(stamps, min(count, len(stamps)), replace=False)
            choices[f"{DRAW} {k + 1}"] = np.sort(drawn)
        for name, each in choices.items():
            file = folder / f"{sequence}_{name}.txt".replace(" ", "_")
            file.write_text(_chosen(data / run, each), encoding="utf-8")
            out.append({"dataset": "trajectory", "label": f"{sequence} {name}",
                        "estimate": str(file), "frames": run, "reference": closed["reference"]})
    return out


def run_config(name, program):
    """The results of a config file or of an entry of runs.yaml; those of the article's own tables
    also at other keyframes."""
    if name in RUNS["configs"]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"{name}.yaml"
            file.write_text(config_text(name), encoding="utf-8")
            return run_config(file, program)
    config = _run(Path(name), program)
    if config.baseline != ORB or not program.data:
        return config
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if datasets := _at_real_stamps(config.options, Path(program.data), folder):
            methods = [m for m in config.options["methods"]
                       if m["label"].startswith((ORB, "equations ", "text "))]
            other = {**config.options, "datasets": datasets, "methods": methods}
            (folder / "real.yaml").write_text(yaml.safe_dump(other), encoding="utf-8")
            config.cells += _run(folder / "real.yaml", program).cells
    return config
