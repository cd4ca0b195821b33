"""`doctor` on the files of every shipped config: each finding is in the table of results/doctor/README.md. Arguments:
loopbench, source folder; needs LOOPBENCH_DATA and PyYAML."""

import fnmatch
import glob
import json
import os
import re
import subprocess
import sys
from pathlib import Path

try:
    import yaml
except ImportError:
    sys.exit(77)

LOOPBENCH, ROOT = sys.argv[1], Path(sys.argv[2])
DATA = os.environ.get("LOOPBENCH_DATA", "")


def inputs(dataset):
    """Arguments of `doctor` for the files of a dataset; patterns stand for several."""
    def files(key):
        return sorted(glob.glob(os.path.join(DATA, dataset[key]))) if dataset.get(key) else []

    for key in ("estimate", "frames"):
        references = files("reference")
        for i, estimate in enumerate(files(key)):
            yield references[min(i, len(references) - 1)], estimate
    for graph in files("path"):
        if graph.endswith(".g2o"):
            yield graph,


def quoted():
    """Kinds of findings by pattern of the file that they are found in."""
    page = (ROOT / "results" / "doctor" / "README.md").read_text(encoding="utf-8")
    for kinds, patterns in re.findall(r"^\| (`\w+`(?:, `\w+`)*) \| (`[^|]+`) \|", page, re.MULTILINE):
        for pattern in re.findall(r"`([^`]+)`", patterns):
            for kind in re.findall(r"`(\w+)`", kinds):
                yield kind, pattern


def main():
    if not os.path.isdir(DATA):
        print("skipped: no folder LOOPBENCH_DATA")
        sys.exit(77)
    pairs = {}
    for config in sorted([*ROOT.glob("configs/*.yaml"), *ROOT.glob("results/methods/configs/*.yaml")]):
        for dataset in yaml.safe_load(config.read_text(encoding="utf-8")).get("datasets", []):
            if dataset.get("dataset") in ("trajectory", "pose_graph"):
                pairs.update(dict.fromkeys(inputs(dataset)))
    known, used, missing = list(quoted()), set(), []
    for words in pairs:
        command = [LOOPBENCH, "doctor", *words, "--repeats", "keep_first", "--json"]
        done = subprocess.run(command, capture_output=True, text=True)
        name = os.path.relpath(words[-1], DATA)
        if done.returncode not in (0, 1):
            missing.append(f"{name}: {done.stderr}")
            continue
        for finding in (each for file in json.loads(done.stdout) for each in file["findings"]):
            found = {each for each in known if each[0] == finding["fault"] and fnmatch.fnmatch(name, each[1])}
            used |= found
            if not found:
                missing.append(f"{name}: {finding['fault']}: {finding['evidence']}")
    missing += [f"{' in '.join(each)} is quoted, but not found" for each in known if each not in used]
    print(f"{len(pairs)} inputs", *missing, sep="\n")
    sys.exit(bool(missing) or len(pairs) < 50)


main()
