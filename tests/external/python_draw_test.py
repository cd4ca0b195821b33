"""Figures of the Python package. First argument: loopbench. Exits with 77 without matplotlib."""

import itertools
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib  # noqa: F401
    import numpy as np

    from loopbench import draw, panels, render, scores
except ImportError as missing:
    print(missing)
    sys.exit(77)


def curve(name, error=0.0, count=200):
    """A loop in the plane that turns by 720 deg."""
    angles = [4.0 * math.pi * i / count for i in range(count)]
    out = {"name": name, "time": angles, "distance": angles,
           "x": [1e3 * math.cos(a) + error for a in angles],
           "y": [1e3 * math.sin(a) for a in angles], "z": [0.0] * count,
           "yaw": [(math.degrees(a) + 180.0) % 360.0 - 180.0 for a in angles]}
    if name != "reference":
        out.update(error=[error] * count, error_x=[error * math.sin(a) for a in angles],
                   angle=angles, sorted_errors=[error] * count)
    return out


def data_of(*names, **texts):
    estimates = [curve(name, 0.1 * (i + 1)) for i, name in enumerate(names)]
    return {**texts, "curves": [curve("reference"), *estimates]}


def scores_of(methods):
    """Two sequences with three runs of each method, and costs of two sizes."""
    cells = [{"sequence": s, "method": m, "repeat": r, "ms": 10.0 ** -m,
              "values": [None, [(1 + s) * (1 + m + 0.1 * r), 0, 0, 0]]}
             for s in range(2) for m in range(len(methods)) for r in range(3)]
    growth = [{"family": "f", "unit": "keyframes", "method": m, "sizes": [60, 240, 960],
               "cpu": [1.0, 3.9 + m, 16.0], "memory": [14.0, 15.0, 20.0],
               "cpu_law": "O(n^1.00 ± 0.02)", "memory_law": "O(n^0.10 ± 0.02)"}
              for m in range(len(methods))]
    kinds = [{"label": "ate", "metric": "ate", "unit": "m", "times": times, "relation": "translation",
              "axis": "3d", "protocol": "loopbench"} for times in ("keyframes", "dense")]
    styles = [{"color": panels.COLORS[m % 8], "dash": 1 + m % 5} for m in range(len(methods))]
    ratios = [{"method": name, "ratio": 0.95**m, "interval": [0.9**m, 1.1] if m else None}
              for m, name in enumerate(methods)]
    own = {"methods": methods, "styles": styles, "oracle": [False] * len(methods), "kinds": kinds,
           "stated": [False] * len(methods),
           "sequences": ["room", "it's <here> & $there$"], "growth": growth, "cells": cells}
    comparisons = [{**kinds[1], "baseline": methods[0], "methods": ratios}]
    names = {name: name for name in methods}
    return {"curves": [], "scores": {"scores": own, "comparisons": comparisons, "names": names}}


ALL = ["xy", "xz", "yz", "xyz", "error by time", "error_x by distance", "yaw by time", "histogram", "boxes"]


class Draw(unittest.TestCase):
    def test_texts_are_on_the_page_and_do_not_overlap(self):
        many = [f"method {i}" for i in range(5)]
        for names, columns, size, font in ((["one"], 2, (1.75, 1.575), 7.0),
                                           (many, 1, (3.5, 1.4), 7.0), (many, 4, (4.5, 3.6), 9.0)):
            texts = {"title": "it's <here> & $there$", "note": "2 of 7 are not drawn"}
            data = data_of(*names, **texts)
            for panel in ALL:
                if panel == "xyz" and size[1] < 0.6 * size[0]:
                    continue  # a cube in a flat panel is too small for its labels
                self.expect_apart(draw.figure(data, [panel] * 2, columns, size, font), (panel, names))

    def test_numbers_of_utm_do_not_collide(self):
        for radius, size in itertools.product((0.01, 0.15, 1.0, 8.0), ((1.75, 1.575), (3.5, 2.8))):
            data = data_of("one", "two")
            for each in data["curves"]:
                for name, origin in zip("xyz", (-466512.3, 5427713.8, 312.4)):
                    each[name] = [origin + radius * value for value in each[name]]
            for panel in ("xy", "xz", "yz", "x by time", "y by distance"):
                fig = draw.figure(data, [panel], 1, size)
                self.expect_apart(fig, (panel, radius))
        self.assertEqual(fig.axes[0].get_ylabel(), "y $-$ 5410000 [m]")
        space = draw.figure(data, ["xyz"], 1, (3.5, 2.8)).axes[0]
        self.assertEqual(space.get_xlabel(), "x $+$ 480000 [m]")

    def expect_apart(self, fig, what):
        page, boxes = fig.bbox, self.drawn(fig)
        for text, box in boxes:
            inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1
            self.assertTrue(inside and box.y1 <= page.y1 + 1, (what, text, box))
        for (one, a), (other, b) in itertools.combinations(boxes, 2):
            width = min(a.x1, b.x1) - max(a.x0, b.x0)
            height = min(a.y1, b.y1) - max(a.y0, b.y0)
            self.assertFalse(width > 1 and height > 1, (what, one, other))

    def test_scores_are_on_the_page_and_do_not_overlap(self):
        for names in (["raw", "du_al"], [f"dual + dm_n{i} (turn_max=0.{i})" for i in range(12)]):
            for panel in ("ratio", "time", "boxes", "growth"):
                fig = draw.figure(scores_of(names), [panel])
                boxes = self.drawn(fig)
                for text, box in boxes:
                    inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= fig.bbox.x1 + 1
                    self.assertTrue(inside and box.y1 <= fig.bbox.y1 + 1, (panel, text, box))
                for (one, a), (other, b) in itertools.combinations(boxes, 2):
                    width = min(a.x1, b.x1) - max(a.x0, b.x0)
                    height = min(a.y1, b.y1) - max(a.y0, b.y0)
                    self.assertFalse(width > 1 and height > 1, (panel, names, one, other))

    def test_rows_are_sorted_and_boxes_are_of_each_sequence(self):
        data = scores_of(["slow", "fast"])
        self.assertEqual(len(draw.figure(data, ["boxes", "growth"]).axes), 4)
        self.assertEqual(scores.rows(scores.chosen(data["scores"]), "boxes 1"), ["slow", "fast"])
        time = draw.figure(data, ["time"]).axes[0]
        points = [line.get_xydata()[0].tolist() for line in time.lines[1:]]
        np.testing.assert_allclose(points, [[1.0, 1.1 * 2**0.5], [0.1, 2.1 * 2**0.5]])
        self.assertEqual([text.get_text() for text in time.texts], ["slow", "fast"])
        self.assertEqual(time.get_xlabel(), "time of the method [ms]")

    def test_times_that_programs_state_are_marked(self):
        data = scores_of(["slow", "fast"])
        data["scores"]["scores"]["stated"] = [False, True]
        time = draw.figure(data, ["time"]).axes[0]
        self.assertEqual([text.get_text() for text in time.texts], ["slow", "fast (s)"])
        self.assertEqual(time.get_xlabel(), "time [ms], (s): stated by the program")

    def test_the_front_is_that_of_the_report(self):
        for errors, times, kept in (([1, 2, 3, 2, 4], [4, 2, 3, 3, 1], "11001"), ([1, 1, 1], [2, 2, 3], "110"),
                                    ([1, 1 - 1e-7], [1, 15], "10"), ([4, 3, 2, 1], [1, 2, 2, 2.4], "1011")):
            points = [{"error": e, "ms": t} for e, t in zip(errors, times)]
            front = scores.front(points)
            self.assertEqual("".join("1" if p in front else "0" for p in points), kept)

    def drawn(self, fig):
        """Texts within the range of their axes: matplotlib keeps ticks beyond it, undrawn."""
        hidden = set()
        fig.canvas.draw()
        for axes in fig.axes:
            for axis, (low, high) in ((axes.xaxis, sorted(axes.get_xlim())),
                                      (axes.yaxis, sorted(axes.get_ylim()))):
                for tick in axis.get_major_ticks():
                    if not low <= tick.get_loc() <= high:
                        hidden |= {id(tick.label1), id(tick.label2)}
        renderer = fig.canvas.get_renderer()
        return [(text.get_text(), text.get_window_extent(renderer))
                for text in fig.findobj(matplotlib.text.Text)
                if text.get_visible() and text.get_text().strip() and id(text) not in hidden]

    def test_maps_have_equal_scales(self):
        fig = draw.figure(data_of("one"), ["xy", "xz"])
        fig.canvas.draw()
        for axes in fig.axes[:2]:
            frame = axes.get_window_extent()
            across, up = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
            self.assertAlmostEqual(frame.width / across / (frame.height / up), 1.0, places=6)

    def test_angles_continue_at_the_other_end_of_the_range(self):
        rows = np.array([[0.0, 170.0], [1.0, -175.0], [2.0, -170.0], [3.0, 175.0], [4.0, 0.0], [5.0, 90.0]])
        np.testing.assert_array_equal(panels.broken_at_wraps(rows), [
            [0.0, 170.0], [2 / 3, 180.0], [np.nan] * 2, [2 / 3, -180.0], [1.0, -175.0], [2.0, -170.0],
            [2 + 2 / 3, -180.0], [np.nan] * 2, [2 + 2 / 3, 180.0], [3.0, 175.0], [np.nan] * 2, [4.0, 0.0], [5.0, 90.0]])
        around = panels.broken_at_wraps(rows[:4], 180.0)
        np.testing.assert_array_equal(around[:, 1], [170.0, 185.0, 190.0, 175.0])

    def test_no_line_of_an_angle_is_vertical(self):
        noise = [170.0, -170.0, 175.0, -175.0] * 20
        many = [360.0 * (i / 7.3 % 1.0) - 180.0 for i in range(80)]  # rotates by 49 deg from row to row
        for angles, is_whole in ((noise, True), (many, False)):
            data = {"curves": [{"name": "one", "time": list(range(80)), "yaw": angles}]}
            drawn = draw.figure(data, ["yaw by time"]).axes[0].lines[0].get_xydata()
            steps = np.abs(np.diff(drawn[:, 1]))
            self.assertLess(np.nanmax(steps), 50.0)
            self.assertEqual(not np.isnan(drawn).any(), is_whole)  # noise about 180 deg is drawn from 0 to 360

    def test_more_than_twelve_estimates_have_several_blocks(self):
        data = data_of(*(f"method {i}" for i in range(30)))
        fig = draw.figure(data, ["xy", "error by time", "boxes"], columns=3)
        self.assertEqual(len(fig.axes), 9)
        names = [[text.get_text() for text in legend.get_texts()] for legend in fig.legends]
        self.assertEqual([len(each) for each in names], [13, 13, 13])  # with reference, start and end
        self.assertEqual([each[1] for each in names], ["method 0", "method 10", "method 20"])
        colors = [line.get_color() for axes in fig.axes[1::3] for line in axes.lines]
        self.assertEqual(colors, [panels.COLORS[i % 8] for i in range(30)])
        for i in range(3):
            limits = {(axes.get_xlim(), () if i == 2 else axes.get_ylim()) for axes in fig.axes[i::3]}
            self.assertEqual(len(limits), 1)
        self.assertEqual(len(draw.figure(data_of(*"abcdefghijkl"), ["xy"]).axes), 1)
        self.expect_apart(draw.figure(data, ["error by time", "xy"], 2, (2.4, 2.1), 7.0), "blocks")

    def test_legend_is_limited_and_counts_the_rest(self):
        data = scores_of([f"method {i}" for i in range(20)])
        legend = draw.figure(data, ["growth"]).legends[0]
        names = [text.get_text() for text in legend.get_texts()]
        self.assertEqual((len(names), names[-1]), (15, "and 6 more"))

    def test_colours_are_those_of_the_data_or_of_the_order(self):
        data = data_of("one", "two", "three")
        data["curves"][2].update(color="#123456", dash=1)
        data["curves"][3].update(style=4)
        lines = draw.figure(data, ["error by time"]).axes[0].lines
        expected = [panels.COLORS[0], "#123456", panels.COLORS[4]]
        self.assertEqual([line.get_color() for line in lines], expected)
        self.assertEqual([line.get_linestyle() for line in lines], ["-", "-", "--"])

    def test_colours_are_those_of_the_report(self):
        header = Path(__file__).parents[2] / "harness/answers/report/curve.hpp"
        self.assertEqual(re.findall('"(#[0-9a-f]{6})"', header.read_text()), [*panels.COLORS])

    def test_style_sheets_and_settings_of_the_user_win(self):
        line = lambda **options: draw.figure(data_of("one"), ["error by time"], **options).axes[0]
        with tempfile.TemporaryDirectory() as folder:
            sheet = Path(folder) / "paper.mplstyle"
            sheet.write_text("font.family: serif\nfont.size: 6\naxes.prop_cycle: cycler(color=['k'])")
            with matplotlib.rc_context({"lines.linewidth": 3.0}):
                axes = line(style=[str(sheet)])
            self.assertEqual((axes.lines[0].get_color(), axes.lines[0].get_linewidth()), ("k", 3.0))
            self.assertEqual((axes.xaxis.label.get_family(), axes.xaxis.label.get_size()),
                             (["serif"], 6.0))
            self.assertEqual(line(style=[str(sheet)], font=9).xaxis.label.get_size(), 9.0)
        with self.assertRaises(OSError):
            line(style=["no_such_style"])

    def test_the_plane_is_that_of_the_largest_extent(self):
        data = data_of("one")
        for each in data["curves"]:  # camera axes
            each["y"], each["z"] = [0.01 * x for x in each["x"]], each["y"]
        for plane, labels in ((None, "xzxzy"), ("yz", "yzyzx")):
            flat, space = draw.figure(data, ["plane", "xyz"], plane=plane).axes[:2]
            axes = (flat.xaxis, flat.yaxis, space.xaxis, space.yaxis, space.zaxis)
            self.assertEqual("".join(axis.get_label_text()[0] for axis in axes), labels)
            is_flat = "exaggerated" in space.get_zlabel()
            self.assertEqual(is_flat, plane is None)
            self.assertEqual(space.zaxis_inverted(), plane is None)  # y points down
            limits = (space.get_xlim(), space.get_ylim(), space.get_zlim())
            box = np.ptp(limits, axis=1) / space._box_aspect  # [m] per unit of the drawn box
            self.assertAlmostEqual(box[0] / box[1], 1.0)
            self.assertAlmostEqual(box[0] / box[2], 50.0 if is_flat else 1.0)

    def test_lines_coloured_by_error_are_joined(self):
        lines = draw.figure(data_of("one"), ["xy"]).axes[0].collections[0]
        segments = np.array(lines.get_segments())
        self.assertEqual(lines.get_capstyle(), "round")
        np.testing.assert_array_equal(segments[1:, 0], segments[:-1, 1])

    def test_files_are_complete_and_equal_for_equal_data(self):
        with tempfile.TemporaryDirectory() as folder:
            for suffix, begin in (("svg", b"<?xml"), ("pdf", b"%PDF-"), ("png", b"\x89PNG"),
                                  ("pgf", b"%% Creator")):
                files = [Path(folder) / "new" / f"{i}.{suffix}" for i in range(2)]
                for file in files:
                    draw.save(draw.figure(data_of("it's <here>_$"), ["xy", "xyz"]), file)
                written = files[0].read_bytes()
                self.assertTrue(written.startswith(begin))
                self.assertEqual(written, files[1].read_bytes(), suffix)
            self.assertIn("it's &lt;here&gt;_$", (Path(folder) / "new/0.svg").read_text())
            self.assertIn(r"it's <here>\_\$", (Path(folder) / "new/0.pgf").read_text())
            self.compile(folder, "0.pgf")
            fig = draw.figure(scores_of(["ra_w", "#2"]), ["ratio", "time", "boxes", "growth"])
            draw.save(fig, Path(folder) / "new/1.pgf")
            self.compile(folder, "1.pgf")

    def compile(self, folder, name):
        if shutil.which("pdflatex") is None:
            return
        page = r"\documentclass{article}\usepackage{pgf}\begin{document}\input{%s}\end{document}"
        line = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", page % name]
        out = subprocess.run(line, cwd=Path(folder) / "new", stdout=subprocess.PIPE, text=True)
        self.assertEqual(out.returncode, 0, out.stdout)

    def test_the_script_draws_the_same_figure(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "my.mplstyle").write_text("axes.edgecolor: blue")
            figure = {"files": ["a.svg", "a.pdf"], "panels": ["plane"], "columns": 1,
                      "size": [3, 2], "style": ["my.mplstyle", "ggplot"], "script": True}
            document = json.dumps([{**data_of("one"), "figures": [figure]}])
            script = [sys.executable, render.__file__]
            subprocess.run(script, input=document.encode(), cwd=folder, check=True)
            files = [Path(folder) / name for name in ("a.svg", "a.pdf")]
            drawn = [file.read_bytes() for file in files]
            for file in files:
                file.unlink()
            subprocess.run([sys.executable, "-B", Path(folder) / "a.py"], cwd="/", check=True)
            self.assertEqual([file.read_bytes() for file in files], drawn)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
