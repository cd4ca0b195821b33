"""Figures 5 to 8: reference red and thickest, ORB-SLAM2 green, ours blue and thinnest, so that
coinciding curves are visible; curves are cut where they leave the surroundings of the reference."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from article.cells import ORB, find_cell, moved
from article.drawing import BLUE, GREEN, RED, Panel, Series, thinned, write_figure
from article.printed import CURVES, SEGMENTS, VALUES
from article.verdicts import plain
from loopbench import manifold

MARGIN = 0.3  #: around the reference [m]
PLANAR, SPATIAL = ("N3", "N4 parabola", "N5 parabola"), ("M6", "M7", "M8")
CUBICS = ("N3", "N4 cubic", "N5 cubic")  #: of panels b, d, f, whose quoted curves are cubics
#: Figure of local segments, and its two segments of SEGMENTS; the next figure is the complete run.
LOCAL = {"fr1_room": (5, 0, 1), "fr3_office": (7, 4, 5)}


@dataclass
class Span:
    """Segment of a run with its speeds [m/s] and kappa [rad per keyframe]."""

    begin: float = -math.inf  #: [s]
    end: float = math.inf
    first: int = 0
    speed: tuple[float, float] = (0.0, 0.0)
    kappa: tuple[float, float] = (0.0, 0.0)


@dataclass
class Figure:
    panels: list[Panel] = field(default_factory=list)
    caption: str = ""

    def add(self, panel, title, details):
        letter = chr(ord("a") + len(self.panels))
        panel.title = f"({letter}) {title}"
        self.caption += f"- ({letter}) {title}" + (f": {details}" if details else "") + "\n"
        self.panels.append(panel)


def _positions(rows, span):
    inside = (rows[:, 0] >= span.begin) & (rows[:, 0] <= span.end)
    return thinned(rows[inside, 1:4])


def _near(points, truth):
    """Breaks a line where it leaves the box of the reference by more than the margin."""
    inside = np.all((points > truth.min(0) - MARGIN) & (points < truth.max(0) + MARGIN), axis=1)
    return np.where(inside[:, None], points, math.nan)


def _panel(ours, raw, span, spatial):
    truth = _positions(raw.reference, span)
    # In the alignment of the raw run, so that a curve through the keyframes is drawn through them.
    curve = moved(raw.alignment, ours.raw_estimate)
    panel = Panel([
        Series("truth", RED, truth, 3.5),
        Series("ORB_SLAM2", GREEN, _near(_positions(raw.estimate, span), truth), 2.0),
        Series("ours", BLUE, _near(_positions(curve, span), truth), 1.0),
    ], spatial=spatial)
    if math.isfinite(span.begin):
        panel.same_scale = False  # centimetres across, metres along
        panel.series.append(
            Series("keyframes", GREEN, _positions(raw.keyframes, span), markers=True))
    return panel


def _printed_curve(quoted, truth):
    """The curve that the article prints for a segment, over the x of the truth, broken where it
    leaves the surroundings; none if it is nowhere near."""
    curve = [c for c in CURVES if c.where.startswith(quoted.where)][-1]
    x = np.linspace(truth[:, 0].min(), truth[:, 0].max(), 100)
    points = _near(np.column_stack([x, curve.f(x), np.full(len(x), truth[:, 2].mean())]), truth)
    return [Series("printed", "#000000", points, 1.5)] if np.isfinite(points).any() else []


def _segment_like(keyframes, printed, wanted):
    """The segment of at least five nodes whose speed range overlaps the printed one best."""
    path, speeds = manifold.KeyframePath(keyframes), manifold.speeds(keyframes)
    kappa, best, best_overlap = path.curvatures(), None, -math.inf
    for first, last in path.segments(printed.speed_band, printed.turn_max):
        if last - first + 1 < 5:
            continue
        own = speeds[first:last]
        inner = kappa[first + 1 : last]
        span = Span(keyframes[first, 0], keyframes[last, 0], first, (own.min(), own.max()),
                    (inner.min(), inner.max()))
        # Intersection over union; negative for disjoint ranges, so that the nearest wins.
        overlap = ((min(span.speed[1], wanted[1]) - max(span.speed[0], wanted[0]))
                   / (max(span.speed[1], wanted[1]) - min(span.speed[0], wanted[0])))
        if overlap > best_overlap:
            best, best_overlap = span, overlap
    return best


def _drawable(cell):
    return cell is not None and cell.estimate is not None


def _local_figure(cells, raw, reading, printed, segments):
    out = Figure()
    for row, variants in enumerate(zip(PLANAR, CUBICS)):
        for variant, quoted in zip(variants, segments):
            planar = find_cell(cells, raw, reading, variant)
            span = _segment_like(raw.keyframes, printed, quoted.speed)
            if not _drawable(planar) or span is None:
                continue
            window = raw.keyframes[span.first : span.first + 3 + row, 1:3]
            equation = manifold.polynomial_text(window, 3 if "cubic" in variant else 2)
            panel = _panel(planar, raw, span, False)
            if reading == "text" and quoted.candidate.startswith(variant):
                panel.series += _printed_curve(quoted, panel.series[0].points)
            out.add(
                panel, f"{raw.sequence} {reading} {variant}",
                f"tau {span.speed[0]:.4f} to {span.speed[1]:.4f} m/s (printed"
                f" {plain(quoted.speed[0])} to {plain(quoted.speed[1])}), kappa"
                f" {span.kappa[0]:.4f} to {span.kappa[1]:.4f} rad per keyframe (printed"
                f" {plain(quoted.kappa[0])} to {plain(quoted.kappa[1])})"
                + (f"; first window: {equation}" if reading == "text" else ""))
    return out


def _global_figure(cells, raw, reading):
    out = Figure()
    for variants in zip(PLANAR, SPATIAL):
        for axis, variant in zip("yz", variants):
            ours = find_cell(cells, raw, reading, variant)
            if not _drawable(ours):
                continue
            found = ours.axis(axis, "dense")
            out.add(_panel(ours, raw, Span(), axis == "z"), f"{raw.sequence} {reading} {variant}",
                    f"ATE along {axis} {found['ate']:.4f} m, densely" if found else "")
    return out


def run_figures(cells, reading, folder):
    """Writes figure5.svg to figure8.svg of this reading on the closed runs; names and captions."""
    out = []
    for printed in VALUES:
        raw = next((c for c in cells if c.method == ORB
                    and c.dataset == f"{printed.sequence} closed"), None)
        if raw is None or raw.keyframes is None:
            continue
        number, *segments = LOCAL[printed.sequence]
        local = _local_figure(cells, raw, reading, printed, [SEGMENTS[k] for k in segments])
        for name, figure, caption in (
            (number, local, "Segments fitted locally, N = 3, 4, 5 from top to bottom: the segments of"
                            " our run whose speeds are nearest to the quoted ones."),
            (number + 1, _global_figure(cells, raw, reading),
             "The complete run: left the xoy plane for N = 3, 4, 5, right xyz for M = 6, 7, 8."),
        ):
            if figure.panels:
                write_figure(folder / f"figure{name}.svg", figure.panels, 2)
                out.append((f"figure{name}.svg",
                            f"**Figure {name}.** {caption}\n\n{figure.caption}"))
    return out
