"""Figures 1 to 4, which the article draws as sketches, from data: drift and joints (1), real and
straight motion between four keyframes with a Frenet frame (2), the candidates of psi at a node (3),
binormals at two nodes and the angle between them (4). Figure 1 (a) uses the open run of fr1_room, the
others the reference at the keyframes of its closed run, around the inner node with the largest angle
between steps."""

from __future__ import annotations

import math

import numpy as np

from article.cells import ORB
from article.drawing import BLUE, FAINT, GREEN, RED, Panel, Series, thinned, write_figure
from loopbench import manifold

BLACK = "#000000"


def _unit(vector):
    length = np.linalg.norm(vector)
    return vector / length if length > 0 else vector


class Bend:
    """The reference at the keyframes, and four of its nodes around a bend."""

    def __init__(self, raw):
        self.keyframes = raw.true_keyframes
        self.path = manifold.KeyframePath(self.keyframes)
        self.steps = manifold.steps(self.keyframes)
        self.node, largest = 3, 0.0
        turns = manifold.angles(self.steps[:-1], self.steps[1:])  # at node k + 1
        for i in range(3, len(self.keyframes) - 3):
            if largest < turns[i - 1] <= 0.25 * math.pi:
                largest, self.node = turns[i - 1], i
        first, last = self.keyframes[self.node - 1, 0], self.keyframes[self.node + 2, 0]
        stamps = raw.reference[:, 0]
        self.real = raw.reference[(stamps >= first) & (stamps <= last), 1:4]
        self.turn = turns[self.node - 1]
        self.step = np.linalg.norm(self.steps[self.node])

    def at(self, node):
        return self.keyframes[node, 1:4]

    def corners(self):
        return self.keyframes[self.node - 1 : self.node + 3, 1:4]

    def binormal(self, node):
        return _unit(np.cross(self.steps[node - 1], self.steps[node]))


def _arrow(name, color, start, along, width):
    return Series(name, color, np.array([start, start + along]), width)


def _drift_and_joints(open_run, bend):
    drift = Panel([
        Series("real path", RED, thinned(open_run.reference[:, 1:4]), 2.5),
        Series("image matching alone", BLUE, thinned(open_run.estimate[:, 1:4]), 1.2),
    ], "(a) fr1_room open: drift")
    stamps = bend.keyframes[bend.node - 1 : bend.node + 3, 0]
    times = np.concatenate([np.linspace(a, b, 21) for a, b in zip(stamps, stamps[1:])])
    joints = Panel([
        Series("C1", BLUE, bend.path.spline(times), 1.6),
        Series("C0", FAINT, bend.corners(), 1.2),
        Series("keyframes", BLACK, bend.corners(), markers=True),
    ], "(b) C0 (straight lines) and C1 (spline) at keyframes", spatial=True)
    return [drift, joints]


def _frenet(bend):
    tangent = _unit(bend.path.velocity(bend.node))
    binormal, point, size = bend.binormal(bend.node), bend.at(bend.node), 0.5 * bend.step
    return Panel([
        Series("real", RED, bend.real, 2.5),
        Series("straight lines", BLUE, bend.corners(), 1.2),
        Series("nodes", BLACK, bend.corners(), markers=True),
        _arrow("T", GREEN, point, size * tangent, 3.0),
        _arrow("N", "#9467bd", point, size * _unit(np.cross(binormal, tangent)), 3.0),
        _arrow("B", "#ff7f0e", point, size * binormal, 3.0),
    ], "nodes 1 to 4, {T, N, B} at node 2", spatial=True)


def _psi(bend):
    """The panel, and the largest angle between a candidate and psi [deg]."""
    candidates = bend.path.tangent_candidates(bend.node)
    psi, point = bend.path.optimal_tangent(bend.node), bend.at(bend.node)
    series = [Series("S", RED, bend.real, 2.5)]
    series += [_arrow(f"psi_{k + 1}", FAINT, point, bend.step * each, 1.2)
               for k, each in enumerate(candidates)]
    series.append(_arrow("psi", BLUE, point, 1.2 * bend.step * psi, 3.0))
    widest = np.max(manifold.angles(candidates, np.tile(psi, (len(candidates), 1))))
    return Panel(series, "candidates and the optimal tangent psi at p", spatial=True), widest


def _torsion(bend):
    size, here, there = 0.6 * bend.step, bend.node, bend.node + 1
    return Panel([
        Series("S", RED, bend.real, 2.5),
        Series("nodes", BLACK, np.array([bend.at(here), bend.at(there)]), markers=True),
        _arrow("B(t)", BLUE, bend.at(here), size * bend.binormal(here), 3.0),
        _arrow("B(t + dt)", GREEN, bend.at(there), size * bend.binormal(there), 3.0),
        _arrow("B(t) moved", FAINT, bend.at(there), size * bend.binormal(here), 1.2),
    ], "binormals at P(t) and P(t + dt)", spatial=True)


def schematic_figures(cells, folder):
    """Writes figure1.svg to figure4.svg; file names and captions. None without these runs."""
    runs = {c.input: c for c in cells if (c.method, c.sequence) == (ORB, "fr1_room")}
    closed, opened = runs.get("closed"), runs.get("open")
    if not all(c and c.keyframes is not None and len(c.keyframes) > 8 for c in (closed, opened)):
        return []
    bend = Bend(closed)
    psi, widest = _psi(bend)
    torsion = manifold.angles(bend.binormal(bend.node), bend.binormal(bend.node + 1))[0]
    for number, panels in enumerate(
        (_drift_and_joints(opened, bend), [_frenet(bend)], [psi], [_torsion(bend)]), 1
    ):
        write_figure(folder / f"figure{number}.svg", panels, len(panels))
    return [
        ("figure1.svg",
         "**Figure 1.** (a) the estimate without loop closing drifts from the real path; (b) keyframes"
         " joined with C0 and C1.\n"),
        ("figure2.svg",
         "**Figure 2.** Four keyframes of the reference, the real motion between them, and the Frenet"
         f" frame at a node with kappa {bend.turn:.2f} rad per keyframe.\n"),
        ("figure3.svg",
         "**Figure 3.** Candidates of psi (chords, principal axis, spline tangent) and the one chosen;"
         f" the widest is {math.degrees(widest):.1f} deg from it.\n"),
        ("figure4.svg",
         "**Figure 4.** Binormals at neighbouring nodes; the angle between them is"
         f" {math.degrees(torsion):.1f} deg.\n"),
    ]
