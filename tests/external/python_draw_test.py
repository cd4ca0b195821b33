"""Figures of the Python package. First argument: loopbench. Exits with 77 without matplotlib."""

import itertools
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib  # noqa: F401
    import numpy as np

    from loopbench import draw, panels, render
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


ALL = ["xy", "xz", "yz", "xyz", "error by time", "error_x by distance", "yaw by time", "histogram"]


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
                fig = draw.figure(data, [panel] * 2, columns, size, font)
                page, boxes = fig.bbox, self.drawn(fig)
                for text, box in boxes:
                    inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1
                    self.assertTrue(inside and box.y1 <= page.y1 + 1, (panel, names, text, box))
                for (one, a), (other, b) in itertools.combinations(boxes, 2):
                    width = min(a.x1, b.x1) - max(a.x0, b.x0)
                    height = min(a.y1, b.y1) - max(a.y0, b.y0)
                    self.assertFalse(width > 1 and height > 1, (panel, names, one, other))

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

    def test_angles_break_at_180_degrees(self):
        rows = np.array([[0.0, 170.0], [1.0, -175.0], [2.0, -170.0]])
        broken = panels.broken_at_wraps(rows)
        self.assertEqual(len(broken), 4)
        self.assertTrue(np.isnan(broken[1]).all())

    def test_legend_is_limited_and_counts_the_rest(self):
        data = {"curves": [curve(f"method {i}") for i in range(20)]}
        legend = draw.figure(data, ["xy", "xz"]).legends[0]
        names = [text.get_text() for text in legend.get_texts()]
        self.assertEqual(names[-2:], ["method 10", "and 9 more"])

    def test_colours_are_those_of_the_data_or_of_the_order(self):
        data = data_of("one", "two")
        data["curves"][2].update(color="#123456", dash=2)
        lines = draw.figure(data, ["error by time"]).axes[0].lines
        self.assertEqual([line.get_color() for line in lines], [panels.COLORS[0], "#123456"])
        self.assertEqual([line.get_linestyle() for line in lines], ["-", "--"])

    def test_files_are_complete_and_equal_for_equal_data(self):
        with tempfile.TemporaryDirectory() as folder:
            for suffix, begin in (("svg", b"<?xml"), ("pdf", b"%PDF-"), ("png", b"\x89PNG")):
                files = [Path(folder) / "new" / f"{i}.{suffix}" for i in range(2)]
                for file in files:
                    draw.save(draw.figure(data_of("it's <here>"), ["xy", "xyz"]), file)
                written = files[0].read_bytes()
                self.assertTrue(written.startswith(begin))
                self.assertEqual(written, files[1].read_bytes(), suffix)
            self.assertIn("it's &lt;here&gt;", (Path(folder) / "new/0.svg").read_text())

    def test_the_script_draws_the_data_that_it_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            figure = {"files": ["a.json"], "panels": ["xy"], "columns": 1, "size": [3, 2], "font": 8}
            document = json.dumps([{**data_of("one"), "figures": [figure]}])
            script = [sys.executable, render.__file__]
            subprocess.run(script, input=document.encode(), cwd=folder, check=True)
            subprocess.run([*script, "a.json"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            self.assertGreater(os.path.getsize(Path(folder) / "a.svg"), 1000)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
