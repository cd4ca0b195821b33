"""The program loopbench with the plugin of results/paper/plugin."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass


@dataclass
class Program:
    """`program("export", store)` returns its standard output."""

    file: str
    plugin: str
    data: str = ""
    jobs: int = 2

    def __call__(self, *words, accepted=(0,)):
        done = subprocess.run(
            [self.file, *(str(w) for w in words if w != "")],
            capture_output=True, text=True, check=False,
        )
        if done.returncode not in accepted:
            raise RuntimeError(f"{self.file} {words[0]}: {done.stderr.strip()}")
        return done.stdout

    def run(self, config, out, *options):
        """Runs a sweep; cells that fail are no errors."""
        data = ("--data", self.data) if self.data else ()
        self("run", config, "--out", out, "-j", self.jobs, "--plugin", self.plugin, *data, *options,
             accepted=(0, 1))
