"""Figures 1 to 8: 1 to 4, which the article draws as sketches, from data; 5 to 8 from runs.

Reference red and thickest, ORB-SLAM2 green, ours blue and thinnest, so that coinciding curves are
visible; curves are cut where they leave the surroundings of the reference.
"""

from __future__ import annotations

import math

import numpy as np

from article import manifold
from article.drawing import BLACK, BLUE, FAINT, GREEN, MARKERS, RED, Panel, write_figure
from article.judge_curves import FAMILIES, FAR, nearest_window
from article.statements import ARTICLE, SEQUENCES

MARGIN = 0.3  #: around the reference [m]
PLANAR = ("N3", "N4 parabola", "N5 parabola")
SPATIAL = ("M6 with N4", "M7 with N4", "M8 with N4")  #: N and M together
CUBICS = ("N3", "N4 cubic", "N5 cubic")  #: of panels b, d, f, whose quoted curves are cubics
FIRST = {"fr1_room": 5, "fr3_office": 7}  #: figure of local segments; the next is the complete run


def _thinned(points, most=600):
    """About `most` of the points, with both ends."""
    kept = np.arange(0, len(points), max(1, -(-len(points) // most)))
    return points[np.append(kept, len(points) - 1)] if len(points) > most else points


def _between(rows, begin=-math.inf, end=math.inf):
    """Positions at the stamps from begin to end."""
    return rows[(rows[:, 0] >= begin) & (rows[:, 0] <= end), 1:4]


def _near(points, truth):
    """Breaks a line where it leaves the box of the reference by more than the margin."""
    inside = np.all((points > truth.min(0) - MARGIN) & (points < truth.max(0) + MARGIN), axis=1)
    return np.where(inside[:, None], points, math.nan)


def _unit(vector):
    return vector / (np.linalg.norm(vector) or 1.0)


def _arrow(name, color, start, along, width):
    return name, color, np.array([start, start + along]), width


def sketches(closed, opened):
    """Panels and numbers of figures 1 to 4. Figure 1 (a) uses the open run, the others the
    reference at the keyframes of the closed run, around the inner node with the largest angle between
    steps, up to 45 degrees."""
    nodes = closed.true_keyframes
    points, stamps, path = nodes[:, 1:4], nodes[:, 0], manifold.KeyframePath(nodes)
    steps, turns = manifold.steps(nodes), path.curvatures()
    inner = turns[3:-3]
    node = 3 + int(np.argmax(np.where(inner <= 0.25 * math.pi, inner, 0)))
    four = slice(node - 1, node + 3)
    corners, point, size = points[four], points[node], np.linalg.norm(steps[node])
    real = ("real", RED, _between(closed.reference, stamps[node - 1], stamps[node + 2]), 2.5)
    times = np.concatenate([np.linspace(a, b, 21) for a, b in zip(stamps[four], stamps[four][1:])])

    tangent = _unit(path.velocity(node))
    here, there = (_unit(np.cross(steps[k - 1], steps[k])) for k in (node, node + 1))
    candidates, psi = path.tangent_candidates(node), path.optimal_tangent(node)
    panels = {
        1: [Panel("(a) fr1_room open: drift", [
                ("real path", RED, _thinned(_between(opened.reference)), 2.5),
                ("image matching alone", BLUE, _thinned(_between(opened.estimate)), 1.2)]),
            Panel("(b) C0 (straight lines) and C1 (spline) at keyframes", [
                ("C1", BLUE, path.spline(times), 1.6), ("C0", FAINT, corners, 1.2),
                ("keyframes", BLACK, corners, MARKERS)], spatial=True)],
        2: [Panel("nodes 1 to 4, {T, N, B} at node 2", [
                real, ("straight lines", BLUE, corners, 1.2), ("nodes", BLACK, corners, MARKERS),
                _arrow("T", GREEN, point, 0.5 * size * tangent, 3.0),
                _arrow("N", "#9467bd", point, 0.5 * size * _unit(np.cross(here, tangent)), 3.0),
                _arrow("B", "#ff7f0e", point, 0.5 * size * here, 3.0)], spatial=True,
                numbers=(1, corners), view=tangent + here + _unit(np.cross(here, tangent)))],
        3: [Panel("candidates and the optimal tangent psi at p", [
                ("S", *real[1:]),
                *(_arrow(f"psi_{k + 1}", FAINT, point, size * each, 1.2)
                  for k, each in enumerate(candidates)),
                _arrow("psi", BLUE, point, 1.2 * size * psi, 3.0)], spatial=True,
                numbers=(1, corners))],
        4: [Panel("binormals at P(t) and P(t + dt)", [
                ("S", *real[1:]), ("nodes", BLACK, points[node : node + 2], MARKERS),
                _arrow("B(t)", BLUE, point, 0.6 * size * here, 3.0),
                _arrow("B(t + dt)", GREEN, points[node + 1], 0.6 * size * there, 3.0),
                _arrow("B(t) moved", FAINT, points[node + 1], 0.6 * size * here, 1.2)],
                spatial=True, numbers=(1, corners))],
    }
    widest = np.degrees(np.max(manifold.angles(candidates, np.tile(psi, (len(candidates), 1)))))
    torsion = np.degrees(manifold.angles(here, there)[0])
    return panels, {"turn": turns[node], "widest": widest, "torsion": torsion}


def _run_panel(title, ours, raw, segment=None):
    """The reference, the estimate and ours, on the complete run or a segment of it."""
    span = segment["span"] if segment else ()
    truth = _thinned(_between(raw.reference, *span))
    # In the alignment of the raw run, so that a curve through the keyframes is drawn through them.
    curve = raw.alignment.apply(ours.raw_estimate)
    lines = [("truth", RED, truth, 3.5),
             ("ORB_SLAM2", GREEN, _near(_thinned(_between(raw.estimate, *span)), truth), 2.0),
             ("ours", BLUE, _near(_thinned(_between(curve, *span)), truth), 1.0)]
    if segment:
        lines.append(("keyframes", GREEN, _between(raw.keyframes, *span), MARKERS))
    return Panel(title, lines, spatial=ours.variant in SPATIAL, same_scale=not segment)


def _printed_curve(quoted, truth):
    """The curve that the article prints for a segment, over the x of the truth, broken where it
    leaves the surroundings; none if it is nowhere near."""
    x = np.linspace(truth[:, 0].min(), truth[:, 0].max(), 100)
    y = FAMILIES[quoted["best"].split()[1]](quoted["curve"], x)
    points = _near(np.column_stack([x, y, np.full(len(x), truth[:, 2].mean())]), truth)
    return [("printed", BLACK, points, 1.5)] if np.isfinite(points).any() else []


def _overlap(a, b):
    """Intersection over union; negative for disjoint ranges, so that the nearest is largest."""
    return (min(a[1], b[1]) - max(a[0], b[0])) / (max(a[1], b[1]) - min(a[0], b[0]))


def _segment_like(raw, quoted):
    """Five keyframes from where the printed curve is nearest to the reference, if it is near and the
    speeds there are in the quoted range; or the segment of at least five nodes whose speed range
    overlaps the quoted one best."""
    keyframes = raw.keyframes
    path, speeds = manifold.KeyframePath(keyframes), manifold.speeds(keyframes)
    kappa, found, limits = path.curvatures(), [], SEQUENCES[quoted["sequence"]]
    windows, nodes, inside = nearest_window(raw, quoted)
    first = min(np.searchsorted(keyframes[:, 0], nodes[0, 0]), len(keyframes) - 5)
    ranges = ([(first, first + 4)] if inside and windows.distances().min() < FAR else
              path.segments(limits["speed_band"], limits["turn_max"]))
    for first, last in ranges:
        if last - first >= 4:
            own, inner = speeds[first:last], kappa[first + 1 : last]
            found.append({"span": keyframes[[first, last], 0], "first": first,
                          "tau": (own.min(), own.max()), "kappa": (inner.min(), inner.max())})
    return max(found, key=lambda each: _overlap(each["tau"], quoted["speed"]), default=None)


def _local_panels(results, raw):
    """Panels and details of segments, N = 3, 4, 5 from top to bottom."""
    place, curves = f"Figure {FIRST[raw.sequence]} ", ARTICLE["segments"] + ARTICLE["misread"]
    quoted = [s for s in ARTICLE["segments"] if s["place"].startswith(place)]
    for variants in zip(PLANAR, CUBICS):
        for variant, it in zip(variants, quoted):
            ours, segment = results.find(raw, "text", variant), _segment_like(raw, it)
            if ours is None or ours.alignment is None or segment is None:
                continue
            panel = _run_panel(f"{raw.sequence} text {variant}", ours, raw, segment)
            if it["best"].startswith(variant):  # as it is read last
                drawn = [curve for curve in curves if curve["place"].startswith(it["place"])][-1]
                panel.lines.extend(_printed_curve(drawn, panel.lines[0][2]))
            yield panel, ARTICLE["figures"]["segment"].format(**segment)


def _complete_panels(results, raw):
    for variants in zip(PLANAR, SPATIAL):
        for axis, variant in zip("yz", variants):
            ours = results.find(raw, "text", variant)
            if ours and ours.alignment:
                ate = ours.axis(axis, "dense")["ate"]
                yield _run_panel(f"{raw.sequence} text {variant}", ours, raw), f"{axis} {ate:.4f}"


def write_figures(results, folder):
    """Writes figure1.svg to figure8.svg of the closed runs; captions by number."""
    captions, text = {}, ARTICLE["figures"]
    for sequence, number in FIRST.items():
        runs = results.runs(sequence)
        if not runs or runs[0].run != "closed":
            continue
        opened = next((run for run in runs if run.run == "open"), None)
        if opened and len(runs[0].keyframes) > 8 and len(opened.keyframes) > 8:
            panels, numbers = sketches(runs[0], opened)
            for k, each in panels.items():
                write_figure(folder / f"figure{k}.svg", each, len(each))
                captions[k] = text[k].format(**numbers) + "\n"
        for k, panels in ((number, _local_panels), (number + 1, _complete_panels)):
            found = [(panel._replace(title=f"({letter}) {panel.title}"), details)
                     for letter, (panel, details) in zip("abcdef", panels(results, runs[0]))]
            if found:
                write_figure(folder / f"figure{k}.svg", [panel for panel, _ in found], 2)
                captions[k] = text["local" if k == number else "complete"] + "\n\n" + "".join(
                    f"- {panel.title}: {details}\n" for panel, details in found)
    return captions
