"""Degrades full references to what people have, and tabulates what an evaluation loses.

python3 tests/studies/degraded_references.py LOOPBENCH DATA
prints the table of results/references/README.md.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

LEVER_ARM = (0.2, -0.2, 0.28)  # 0.4 m
ORIGIN = (math.radians(48.0), math.radians(11.0), 500.0)
A, E2 = 6378137.0, 0.0066943799901413165  # WGS 84
AT_REFERENCE = ["--association", "interpolate_estimate", "--max-gap", "0.2"]


def rotated(q, v):
    """v in the world; q = x y z w."""
    x, y, z, w = q
    u = (x, y, z)
    cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    t = cross(u, v)
    s = cross(u, t)
    return [v[i] + 2.0 * (w * t[i] + s[i]) for i in range(3)]


def geodetic(p):
    """Latitude, longitude [deg] and height of east, north, up at ORIGIN."""
    lat, lon, height = ORIGIN
    sa, ca, so, co = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    n = A / math.sqrt(1.0 - E2 * sa * sa)
    x = (n + height) * ca * co - so * p[0] - sa * co * p[1] + ca * co * p[2]
    y = (n + height) * ca * so + co * p[0] - sa * so * p[1] + ca * so * p[2]
    z = (n * (1.0 - E2) + height) * sa + ca * p[1] + sa * p[2]
    r = math.hypot(x, y)
    for _ in range(20):
        n = A / math.sqrt(1.0 - E2 * math.sin(lat) ** 2)
        height = r / math.cos(lat) - n
        lat = math.atan2(z, r * (1.0 - E2 * n / (n + height)))
    return [math.degrees(lat), math.degrees(math.atan2(y, x)), height]


def position_rows(rows, point=lambda row: row[1:4]):
    return "".join(f"{row[0]!r} {' '.join(map(repr, point(row)))}\n" for row in rows)


def antenna(row):
    offset = rotated(row[4:8], LEVER_ARM)
    return [row[1 + i] + offset[i] for i in range(3)]


def every_second(rows):
    out = [rows[0]]
    for row in rows:
        if row[0] >= out[-1][0] + 1.0:
            out.append(row)
    return out


def degraded(rows):
    """Name, text of the file and options of each reference."""
    lever_arm = ",".join(map(str, LEVER_ARM))
    ten = [rows[round((k + 0.5) * len(rows) / 10)] for k in range(10)]
    table = "t,latitude,longitude,height\n" + position_rows(
        rows, lambda row: geodetic(row[1:4])).replace(" ", ",")
    return [
        ("positions only", position_rows(rows), []),
        ("positions at 1 Hz", position_rows(every_second(rows)), AT_REFERENCE),
        ("ten points", position_rows(ten), AT_REFERENCE),
        ("antenna at 0.4 m, not stated", position_rows(rows, antenna), []),
        ("antenna at 0.4 m, stated", position_rows(rows, antenna), ["--ref-body", lever_arm]),
        ("latitude, longitude, height", table, []),
    ]


def score(result, metric, relation, axis="3d"):
    for row in result["metrics"]:
        if row["label"] == metric and row["relation"] == relation and row["axis"] == axis:
            return row.get("rmse")
    return None


def evaluated(loopbench, reference, estimate, options, *metrics):
    command = [loopbench, "eval", reference, estimate, "--json", *options]
    for metric in metrics:
        command += ["--metric", metric]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=False).stdout)[0]


def table_row(loopbench, name, reference, estimate, options):
    files = (loopbench, reference, estimate, options)
    result = evaluated(*files, "ate", "rpe:delta=1,unit=s", "lever_arm")
    distances = evaluated(*files, "rpe:delta=1,unit=s,relation=point_distance")
    text = lambda value, digits: "-" if value is None else f"{value:.{digits}f}"
    arm = []
    for axis in "xyz":
        value, half = (score(result, "lever_arm", what, axis) for what in ("position", "half_width"))
        arm.append("?" if value is None else f"{value:.2f} +- {half:.2f}")
    return (f"| {name} | {result['pairs']} | {text(score(result, 'ate', 'translation'), 4)} | "
            f"{text(score(result, 'ate', 'rotation'), 2)} | "
            f"{text(score(result, 'rpe 1 s', 'translation'), 4)} | "
            f"{text(score(distances, 'rpe 1 s', 'point_distance'), 4)} | {', '.join(arm)} |")


def study(loopbench, title, reference, estimate, folder):
    """A table of one recording."""
    files = []
    for k, file in enumerate((reference, estimate)):  # KITTI files get stamps
        files.append(str(folder / f"{k}.txt"))
        subprocess.run([loopbench, "traj", "convert", file, "--to", "tum", "-o", files[-1]],
                       capture_output=True, check=True)
    lines = pathlib.Path(files[0]).read_text().splitlines()
    rows = [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]
    print(f"\n{title}:\n")
    print("| reference | pairs | ATE [m] | ATE [deg] | RPE 1 s [m] | distance error 1 s [m] | estimated lever arm [m] |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | --- |")
    print(table_row(loopbench, "full", files[0], files[1], []))
    for name, text, options in degraded(rows):
        file = folder / "degraded.csv"
        file.write_text(text)
        print(table_row(loopbench, name, str(file), files[1], options))


def main():
    loopbench, data = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        room, route = data / "tum_rgbd/fr1_room", data / "kitti/00"
        study(loopbench, "fr1_room, ORB-SLAM2 without loops", room / "groundtruth.txt",
              room / "orbslam2_rgbd_open_frames.txt", pathlib.Path(folder))
        study(loopbench, "KITTI 00, KISS-ICP", route / "gt_poses.txt", route / "kiss_icp_open.txt",
              pathlib.Path(folder))


if __name__ == "__main__":
    main()
