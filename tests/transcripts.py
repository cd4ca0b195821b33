#!/usr/bin/env python3
"""Runs commands as a user types them and compares what they print with tests/transcripts/*.txt.

    # A comment.
    $ loopbench eval $DATA/golden/gt.txt absent.txt
    loopbench: absent.txt: file not found
    [2]

A file runs in a folder of its own. `$ ` begins a command for bash, `> ` continues it (for example the text of a file),
$DATA is tests/data. Both outputs are expected in the order of printing, then the exit code unless it is 0. `...` in a line
stands for any text, `...` alone for any lines. The folder is printed as FOLDER, times as "_ ms".
tests/transcripts/paths.sh and drive.py write trajectories for them.

Usage: transcripts.py LOOPBENCH [--update] [NAME...]; --update writes what is printed where it differs.
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent


def steps_of(text):
    """Lines of a command and of its expected output; no command: a comment, which follows an empty line."""
    steps = []
    before = ""
    for line in text.splitlines():
        if line.startswith("$ "):
            steps.append(([line], []))
        elif line.startswith("> ") and steps[-1][0] and not steps[-1][1]:
            steps[-1][0].append(line)
        elif line.startswith("# ") and before == "":
            steps.append(([], [line]))
        else:
            steps[-1][1].append(line)
        before = line
    return steps


def plain(text, folder):
    text = re.sub(r"\d+(\.\d+)? ms\b", "_ ms", text.replace(str(folder), "FOLDER"))
    return [line.rstrip() for line in text.splitlines()]


def matches(expected, printed):
    any_text = lambda line: ".*".join(re.escape(part) for part in line.split("..."))
    pattern = "".join("(?:.*\n)*?" if line == "..." else any_text(line) + "\n" for line in expected)
    return re.fullmatch(pattern, "".join(line + "\n" for line in printed)) is not None


def run(command, loopbench, folder):
    environment = os.environ | {"DATA": str(ROOT / "data"), "COLUMNS": "0", "LC_ALL": "C.UTF-8",
                                "LOOPBENCH_NAME": "loopbench"}
    script = f"loopbench() {{ '{loopbench}' \"$@\"; }}\n{command}\n"
    ended = subprocess.run(["bash", "-c", script], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    printed = plain(ended.stdout.decode(errors="replace"), folder)
    return printed + ([f"[{ended.returncode}]"] if ended.returncode else [])


def check(file, loopbench, update):
    wrong, out = [], []
    with tempfile.TemporaryDirectory(prefix="transcript-") as folder:
        for command, expected in steps_of(file.read_text()):
            if command:
                separated = expected[-1:] == [""]
                wanted = [line.rstrip() for line in (expected[:-1] if separated else expected)]
                text = "\n".join(line[2:] for line in command)
                printed = run(text, loopbench, folder)
                if not matches(wanted, printed):
                    wrong.append("\n".join([f"{file.name}: {text}", *("  - " + line for line in wanted),
                                            *("  + " + line for line in printed)]))
                    expected = printed + ([""] if separated else [])
            out += command + expected
    if update and wrong:
        file.write_text("\n".join(out) + "\n")
    return wrong


def main():
    words = [word for word in sys.argv[2:] if word != "--update"]
    loopbench = pathlib.Path(sys.argv[1]).resolve()
    files = [file for file in sorted((ROOT / "transcripts").glob("*.txt")) if not words or file.stem in words]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda file: check(file, loopbench, "--update" in sys.argv), files))
    wrong = [text for result in results for text in result]
    print(*wrong, f"{len(files)} transcripts, {len(wrong)} commands print something else", sep="\n")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
