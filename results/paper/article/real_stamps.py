"""The closed runs at stamps where ORB-SLAM2 itself chose keyframes, and at random draws of them.

The keyframes of the article are not public. Its number of them, resampled, is one stand-in; the
stamps of keyframes that ORB-SLAM2 chose in another run of the same recording are another.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from article.cells import DRAW, REAL_STAMPS
from article.printed import VALUES

DRAWS = 3
#: Keyframes whose stamps are taken, and the closed run that has poses at them.
SOURCES = {
    "fr1_room": ("tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt",
                 "tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run0.txt"),
    "fr3_office": ("tum_rgbd/fr3_office/orbslam2_mono_open_keyframes.txt",
                   "tum_rgbd/fr3_office/orbslam2_rgbd_closed_frames_run0.txt"),
}


def _chosen(lines, stamps):
    """The lines of a TUM file nearest to the stamps, within 10 ms."""
    own = np.array([float(line.split()[0]) for line in lines])
    nearest = np.abs(own[:, None] - stamps).argmin(0)
    return [lines[i] for i in np.unique(nearest[np.abs(own[nearest] - stamps) < 0.01])]


def write_config(config, data, folder):
    """Writes a config with these runs and the literal readings of `config`, and its trajectories;
    None if `config` has no closed run of theirs."""
    closed = {d["label"]: d for d in config["datasets"] if d["label"].endswith(" closed")}
    datasets = []
    for values in VALUES:
        keyframes, run = SOURCES[values.sequence]
        entry = closed.get(values.sequence + " closed")
        if entry is None or entry["estimate"] != run:
            continue
        lines = [line for line in (Path(data) / run).read_text(encoding="utf-8").splitlines()
                 if line and line[0] != "#"]
        stamps = np.loadtxt(Path(data) / keyframes)[:, 0]
        random = np.random.default_rng(1)
        choices = {REAL_STAMPS: stamps}
        count = min(values.keyframes, len(stamps))
        for k in range(DRAWS):
            choices[f"{DRAW} {k + 1}"] = np.sort(random.choice(stamps, count, replace=False))
        for name, each in choices.items():
            file = folder / f"{values.sequence}_{name.replace(' ', '_')}.txt"
            file.write_text("\n".join(_chosen(lines, each)) + "\n", encoding="utf-8")
            datasets.append({"dataset": "trajectory", "label": f"{values.sequence} {name}",
                             "estimate": str(file), "frames": run, "reference": entry["reference"]})
    if not datasets:
        return None
    kept = ("ORB_SLAM2", "equations ", "text ")
    out = {**config, "datasets": datasets,
           "methods": [m for m in config["methods"] if m["label"].startswith(kept)]}
    file = folder / "real_stamps.yaml"
    file.write_text("description: >\n  Other keyframes of the closed runs.\n"
                    + yaml.safe_dump({k: v for k, v in out.items() if k != "description"}),
                    encoding="utf-8")
    return file
