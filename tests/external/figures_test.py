"""Figures of `plot`, `eval` and `traj plot`, and the commands of metrics/evo.md, some of which draw. First argument:
loopbench. Exits with 77 without matplotlib."""

import csv
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib  # noqa: F401
except ImportError as missing:
    print(missing)
    sys.exit(77)

PROGRAM = os.path.abspath(sys.argv[1])
# Of evo 1.36.5: `evo_ape tum --help` and so on.
EVO_OPTIONS = """
-r --pose_relation -s --correct_scale --n_to_align --change_unit --project_to_plane --downsample --motion_filter
-a --align --align_origin -p --plot --plot_mode --plot_x_dimension --plot_colormap_max --plot_colormap_min
--plot_colormap_max_percentile --plot_full_ref --ros_map_yaml --map_tile --save_plot --rerun --rerun_rec_id
--save_results --logfile --no_warnings -v --verbose --silent --debug -c --config --t_max_diff --t_offset
--t_start --t_end -d --delta -t --delta_tol -u --delta_unit --all_pairs --pairs_from_reference -f --full_check
--sync --transform_left --transform_right --propagate_transform --invert_transform --ref --merge
--plot_relative_time --save_table --save_as_tum --save_as_kitti --save_as_bag --save_as_bag2 --show_full_names
--all_topics --all_channels --use_rel_time --use_filenames --ignore_title --plot_markers --brief --no_color
--diff -m --soft -o --out -y --title --serialize_plot --to_html --version --license --info --location --pyversion
--open_log --clear_log"""
ROOM = "{dataset: simulated, keyframes: 40, label: %s}"


def mcap(rows):
    """An MCAP with poses of rows of TUM on the topic /pose."""
    text = lambda word: struct.pack("<I", len(word)) + word
    record = lambda op, content: struct.pack("<BQ", op, len(content)) + content
    out = record(3, struct.pack("<H", 1) + text(b"geometry_msgs/msg/PoseStamped") + text(b"ros2msg") + text(b""))
    out += record(4, struct.pack("<HH", 1, 1) + text(b"/pose") + text(b"cdr") + text(b""))
    for stamp, *numbers in rows:
        at = round(1e9 * stamp)
        pose = struct.pack("<IiII4x7d", 256, at // 10**9, at % 10**9, 1, *numbers)  # the name of the frame is empty
        out += record(5, struct.pack("<HIQQ", 1, 0, at, at) + pose)
    statistics = struct.pack("<QHIIIIQQI", len(rows), 1, 1, 0, 0, 0, 0, 0, 0)
    return b"\x89MCAP0\r\n" + out + record(11, statistics) + record(2, bytes(20)) + b"\x89MCAP0\r\n"


def named_and_run(page):
    """Words in code that are not in commands of loopbench, and commands. In the second column of the table, options
    continue the last command before them."""
    named, commands, command = set(), [], ""
    for line in page.splitlines():
        is_row = line.startswith("| ")
        for column, text in enumerate(line.split(" | ") if is_row else [line]):
            for code in re.findall("`([^`]*)`", text):
                if code.startswith("loopbench "):
                    commands.append(command := code)
                    continue
                named.update(code.split())
                if is_row and column == 1 and code.startswith("-"):
                    commands.append(f"{command} {code}")
    return named, commands


class Figures(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def call(self, line, code=0, **variables):
        """Output and errors of `loopbench LINE` in a shell."""
        done = subprocess.run(f"'{PROGRAM}' {line}", shell=True, cwd=self.folder, env=os.environ | variables,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, code, line + done.stdout + done.stderr)
        return done.stdout, done.stderr

    def sweep(self, datasets, methods="raw", more=""):
        """A store named r."""
        text = f"datasets: [{datasets}]\nmethods: [{methods}]\nmetrics: [ate]\n{more}"
        (self.folder / "c.yaml").write_text(text)
        self.call("run c.yaml --out r")

    def read(self, name):
        return (self.folder / name).read_bytes()

    def expect_in(self, name, *texts):
        for text in texts:
            self.assertIn(text, self.read(name).decode(), name)

    def test_a_full_disk_is_blamed(self):
        self.sweep(ROOM % "a")
        limited = f"trap '' XFSZ; ulimit -f 0; '{PROGRAM}' plot r -o small --format svg 2>&1 | cat"
        said = subprocess.run(["bash", "-c", limited], cwd=self.folder, capture_output=True, text=True).stdout
        self.assertIn("a temporary file, which cannot be written: File too large", said)
        self.assertNotIn("Traceback", said)
        self.assertFalse((self.folder / "small").exists())

    def test_labels_may_begin_with_a_quote(self):
        self.sweep(ROOM % r'''"'room\e[1m'"''', '''{method: raw, label: "'raw' it's"}''')
        self.call("plot r -o f --format svg")
        drawn = self.read("f/01_room_1m_trajectories.svg").decode()
        self.assertIn("'raw' it's", drawn.replace("&#39;", "'"))

    def test_every_format_and_the_script_that_draws_it(self):
        self.sweep(ROOM % "a")
        (self.folder / "my.mplstyle").write_text("font.family: serif\naxes.edgecolor: blue\n")
        out, _ = self.call("plot r -o f --format svg,pdf,png,pgf --panels plane --style my.mplstyle "
                           "--labels 'My name_1' --script")
        drawn = {f"f/01_a_trajectories.{end}": b"" for end in ("svg", "pdf", "png", "pgf")}
        for name in drawn:
            drawn[name] = self.read(name)
            self.assertGreater(len(drawn[name]), 1000, name)
            self.assertIn(name + "\n", out)
            (self.folder / name).unlink()
        for text in (b">My name_1<", b"#0000ff"):
            self.assertIn(text, drawn["f/01_a_trajectories.svg"])
        subprocess.run([sys.executable, "-B", self.folder / "f/01_a_trajectories.py"], check=True)
        self.assertEqual({name: self.read(name) for name in drawn}, drawn)
        self.assertIn("'nothing' not found in the style library", self.call("plot r --style nothing", 2)[1])

    def test_repeat_and_alignment_are_stated(self):
        self.sweep(ROOM % "a", more="repeats: 2\nprotocol: {align: sim3}\n")
        self.call("plot r -o f --panels plane --format svg")
        self.expect_in("f/01_a_trajectories.svg", ">a, repeat 0 (first of 2), aligned by rotation, translation<")

    def test_sequences_panels_and_size_are_selected(self):
        self.sweep(ROOM % "'off|ice_&%<b>'" + "," + ROOM % "b", "raw, uniform")
        out, _ = self.call("plot r -o f --methods raw,uniform --sequences b --panels xz,angle --size 3,2 "
                           "--format svg --panel-columns 1")
        self.assertEqual(out, "f/02_b_trajectories.svg\nf/02_b_errors.svg\n")
        self.expect_in("f/02_b_trajectories.svg", 'width="216pt" height="', "z [m]", "uniform")
        self.expect_in("f/02_b_errors.svg", "rotation error [deg]")
        self.assertEqual(self.call("plot r -o g --panels x --format png")[0],
                         "g/01_off_ice_b_errors.png\ng/02_b_errors.png\n")
        for wrong, why in (("--sequences c", "--sequences: no sequence is named 'c'"),
                           ("--methods rwa", "did you mean 'raw'?"), ("--panels zx", ""), ("--size 3", "")):
            self.assertIn(why, self.call("plot r " + wrong, 2)[1])

    def test_scores_and_costs_of_all_sequences(self):
        self.sweep("{dataset: simulated, sweep: {keyframes: [20, 40, 80]}}", "raw, uniform", "traces: false\n")
        self.assertIn("f/ratio.svg\nf/time.svg\nf/boxes.svg\nf/growth.svg\n", self.call("plot r -o f --format svg")[0])
        self.expect_in("f/ratio.svg", ">change to raw [%]: ate rmse, dense<")
        self.expect_in("f/growth.svg", ">uniform: time O(n^")
        out, _ = self.call("plot r -o g --panels time,growth --format pgf --methods raw")
        self.assertEqual(out, "g/time.pgf\ng/growth.pgf\n")
        self.assertNotIn(b"uniform", self.read("g/growth.pgf"))
        self.sweep(ROOM % "a", more="traces: false\n")
        self.call("plot r -o h --panels growth", 2)  # one size

    def test_what_stands_in_the_way_is_named(self):
        self.sweep(ROOM % "a")
        out, error = self.call("plot r -o c.yaml", 2)
        self.assertEqual(out, "")
        self.assertIn("cannot be written: Not a directory", error)
        error = self.call("plot r -o without", 2, PATH="/nowhere")[1]
        self.assertIn("python3 is not installed (package python3-matplotlib)", error)

    def write(self, name, first=5, error=0.1, height=0.0):
        """1 m/s along x with a bend in y, one pose per second to 50 s."""
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_text("".join(f"{100 + t} {t} {error * (t % 2)} {height * t} 0 0 0 1\n" for t in range(first, 51)))

    def test_eval_draws_one_page_with_sequence_alignment_and_score(self):
        self.write("room/gt.txt", 0, 0.0)
        self.write("room/a_long_name.txt")
        self.write("room/other_name.txt", error=0.2)
        line = "eval room/gt.txt room/a_long_name.txt room/other_name.txt --align none --plot "
        self.assertEqual(self.call(line + "f/p.svg")[1], "f/p.svg\n")
        self.expect_in("f/p.svg", ">room, not aligned. In brackets: position error (RMSE)<", ">a_long_name (0.0707 m)<",
                       ">other_name (0.141 m)<")
        self.assertEqual(self.call(line + "p")[1], "p.pdf\n")

    def test_traj_plot_has_short_names_and_the_plane_of_camera_axes(self):
        self.write("runs/first.txt", 0, 0.0, height=1.0)
        plot = "traj plot runs/first.txt --panels plane --panel-columns 1 -o "
        for options, name, axes in (("", ">first<", "xz"), ("--plane yz --labels Mine", ">Mine<", "yz")):
            self.call(plot + "f.svg " + options)
            self.expect_in("f.svg", name)
            self.assertEqual("".join(re.findall(r">([xyz]) \[m\]<", self.read("f.svg").decode())), axes)
        self.assertIn(".png or .pgf", self.call(plot + "f.txt", 2)[1])

    def test_the_page_for_users_of_evo_names_every_option_and_its_commands_work(self):
        page = Path(__file__).parents[2] / "metrics/evo.md"
        named, commands = named_and_run(page.read_text())
        self.assertEqual([option for option in EVO_OPTIONS.split() if option not in named], [])
        with open(page.parents[1] / "results/benchmarks/evo_tasks.csv", newline="") as tasks:
            commands += [row["loopbench"] for row in csv.DictReader(tasks)]
        data = page.parents[1] / "tests/data"
        for source, name in (("gt.txt", "gt.txt"), ("est_drift.txt", "a.txt"), ("est_corrected.txt", "b.txt"),
                             ("kitti_gt.txt", "gt.kitti"), ("kitti_est.txt", "a.kitti")):
            shutil.copy(data / "golden" / source, self.folder / name)
        bag = Path(os.environ.get("LOOPBENCH_DATA", "")) / "bags/tf_example.bag"
        self.assertGreater(len(commands), 60)
        if bag.exists():
            shutil.copy(bag, self.folder / "tf.bag")
        rows = (line.split() for line in self.read("a.txt").decode().splitlines() if line[0] != "#")
        (self.folder / "run.mcap").write_bytes(mcap([[*map(float, row)] for row in rows]))
        self.call("traj convert gt.txt --to euroc -o data.csv")
        for line in commands:
            if bag.exists() or "tf.bag" not in line:
                self.call(line.removeprefix("loopbench "))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
