#!/usr/bin/env python3
"""Compares sweeps on a real Slurm cluster of four nodes on this machine with `run --jobs` on the same cores.

    tests/slurm/efficiency.py LOOPBENCH CELLS [PIECES] [SHARDS]

Each of the PIECES is a sweep of CELLS cells that runs both ways, in alternating order, so that other load affects both.
Prints wall times (with and without submission, queueing and merge), processor times of all processes, and their
ratios, as Markdown; ends with an error if the merged store has other rows. Needs root and what run.sh needs.
"""
import ctypes
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

NODES = 4
SWEEP = """datasets:
  - {{dataset: simulated, path: room, keyframes: 180, seed: {seed}, label: room}}
  - {{dataset: simulated, path: office, keyframes: 180, seed: {seed}, label: office}}
methods: [raw, uniform_position, uniform, uniform_open, elch, two_pass, two_pass_open, two_pass_motion, dual,
          dual + cubic_spline]
metrics: [ate, rpe]
times: keyframes
traces: false
limits: {{seconds: 20, memory: 1GiB}}
repeats: {repeats}
"""
CELLS_PER_REPEAT = 20
HERE = pathlib.Path(__file__).resolve().parent


class Processes:
    """Processor time of children, and of orphans below them, such as the slurmstepd of jobs."""

    def __init__(self):
        self.ended = {}  # [s] by process
        pr_set_child_subreaper = 36
        if ctypes.CDLL(None, use_errno=True).prctl(pr_set_child_subreaper, 1, 0, 0, 0) != 0:
            sys.exit("cannot become a subreaper")

    def reap(self):
        """Whether there was a process to reap."""
        try:
            process, _, usage = os.wait4(-1, os.WNOHANG)
        except ChildProcessError:
            return False
        if process != 0:
            self.ended[process] = usage.ru_utime + usage.ru_stime
        return process != 0

    def run(self, words):
        """Runs a program to its end; its processor time [s]."""
        with open(os.devnull, "w") as nothing:
            process = os.posix_spawnp(words[0], words, os.environ,
                                      file_actions=[(os.POSIX_SPAWN_DUP2, nothing.fileno(), 1)])
        while process not in self.ended:
            if not self.reap():
                time.sleep(0.01)
        return self.ended[process]


def descendants(process):
    """Numbers and names of the processes below one."""
    out = []
    for folder in pathlib.Path(f"/proc/{process}/task").glob("*"):
        try:
            children = (folder / "children").read_text().split()
        except OSError:
            continue
        for child in children:
            try:
                out.append((int(child), pathlib.Path(f"/proc/{child}/comm").read_text().strip()))
            except OSError:
                continue
            out += descendants(child)
    return out


def processor_time(process):
    """Of a running process and the children it waited for [s]."""
    text = pathlib.Path(f"/proc/{process}/stat").read_text()
    fields = text[text.rindex(")") + 2:].split()
    return sum(int(field) for field in fields[11:15]) / os.sysconf("SC_CLK_TCK")


class Cluster:
    def __init__(self, folder):
        script = f'set -e; source "{HERE}/cluster.sh"; start_cluster "{folder}" {NODES}; echo ready; read -r || true; stop_cluster'
        self.process = subprocess.Popen(["bash", "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if self.process.stdout.readline() != "ready\n":
            sys.exit("the cluster did not start")
        os.environ["SLURM_CONF"] = f"{folder}/slurm.conf"
        self.daemons = [number for number, name in descendants(self.process.pid)
                        if name in ("munged", "slurmctld", "slurmd")]

    def stop(self):
        self.process.stdin.write("\n")
        self.process.stdin.close()
        self.process.wait()

    def processor_time(self):
        return sum(processor_time(daemon) for daemon in self.daemons)


def run_alone(processes, loopbench, config, out):
    # One shard, because plain `run` also writes tables.
    begin = time.monotonic()
    processor = processes.run([loopbench, "run", config, "--out", out, "--shard", "1/1", "--jobs", "2"])
    return {"wall": time.monotonic() - begin, "processor": processor}


def run_cluster(processes, cluster, loopbench, config, shards, out):
    before, daemons = set(processes.ended), cluster.processor_time()
    begin = time.monotonic()
    processes.run([loopbench, "submit", config, "--array", str(shards), "--out", out])
    submitted = time.monotonic()
    while not os.path.exists(f"{out}/results.sqlite"):
        processes.reap()
        time.sleep(0.05)
    wall = time.monotonic() - begin
    while any(name == "slurmstepd" for _, name in descendants(os.getpid())):
        processes.reap()
        time.sleep(0.05)
    logs = [str(file) for file in pathlib.Path(out, "logs").glob("*_*.txt")]
    births = [float(text) for text in subprocess.check_output(["stat", "-c", "%W", *logs], text=True).split()]
    stores = [os.stat(f"{out}/shards/{i + 1}-of-{len(logs)}/results.sqlite").st_mtime for i in range(len(logs))]
    processor = sum(seconds for process, seconds in processes.ended.items() if process not in before)
    return {"wall": wall, "processor": processor + cluster.processor_time() - daemons,
            "submit": submitted - begin, "shards": max(stores) - min(births)}


def main():
    loopbench, cells = os.path.realpath(sys.argv[1]), int(sys.argv[2])
    pieces = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    shards = int(sys.argv[4]) if len(sys.argv) > 4 else NODES
    processes = Processes()
    folder = tempfile.mkdtemp(prefix="loopbench-efficiency.")
    cluster = Cluster(f"{folder}/cluster")
    print("| piece | load | `--jobs 2`: wall [s] | processor [s] | Slurm: wall [s] | submit [s] | shards [s] | "
          "processor [s] | efficiency: wall | shards | processor |")
    print("|" + " ---: |" * 11, flush=True)
    ratios = []
    try:
        for piece in range(pieces):
            config = f"{folder}/piece-{piece}.yaml"
            pathlib.Path(config).write_text(
                SWEEP.format(seed=1 + piece, repeats=cells // CELLS_PER_REPEAT))
            alone, submitted = f"{folder}/alone-{piece}", f"{folder}/slurm-{piece}"
            for side in ("alone", "slurm") if piece % 2 == 0 else ("slurm", "alone"):
                if side == "alone":
                    a = run_alone(processes, loopbench, config, alone)
                else:
                    b = run_cluster(processes, cluster, loopbench, config, shards, submitted)
            ratio = (a["wall"] / b["wall"], a["wall"] / b["shards"], a["processor"] / b["processor"])
            ratios.append(ratio)
            print(f"| {piece + 1} | {os.getloadavg()[0]:.1f} | {a['wall']:.1f} | {a['processor']:.1f} | {b['wall']:.1f} | "
                  f"{b['submit']:.2f} | {b['shards']:.1f} | {b['processor']:.1f} | "
                  + " | ".join(f"{100 * value:.1f} %" for value in ratio) + " |", flush=True)
            subprocess.run([HERE / "same_rows.py", loopbench, f"{alone}/shards/1-of-1", submitted], check=True,
                           stdout=sys.stderr)
            shutil.rmtree(alone)
            shutil.rmtree(submitted)
        medians = [statistics.median(values) for values in zip(*ratios)]
        print("\nmedians: " + ", ".join(f"{name} {100 * value:.1f} %" for name, value in
                                        zip(("wall", "shards", "processor"), medians)))
    finally:
        cluster.stop()
    shutil.rmtree(folder)


main()
