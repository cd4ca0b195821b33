"""The wheel: built without network, installed in a clean virtual environment without a compiler, and
the first evaluation of the page runs there. Arguments: loopbench, source folder, build folder. Exits
with 77 without pip or the compiled module."""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from python_support import has

SOURCE, BUILD = Path(sys.argv[2]), Path(sys.argv[3])
if not has("pip") or not has("loopbench._core"):
    print("pip or the compiled module is missing")
    sys.exit(77)


def call(*words, **changes):
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("PYTHONPATH", "LOOPBENCH_PROGRAM")}
    done = subprocess.run([*map(str, words)], env={**environment, **changes}, cwd=folder, check=False,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


with tempfile.TemporaryDirectory() as folder:
    pip = sys.executable, "-m", "pip", "--no-cache-dir"
    offline = "--no-index", "--no-deps"
    call(*pip, "wheel", *offline, "-w", folder, "--config-settings", f"build-dir={BUILD}", SOURCE)
    wheel, = Path(folder).glob("loopbench-*.whl")
    # Debian's numpy is visible; all else of the environment is empty.
    call(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", "clean")
    scripts = Path(folder) / "clean" / "bin"
    call(*pip, "--python", scripts / "python", "install", "--no-compile", *offline, wheel)
    page = (SOURCE / "harness/python/README.md").read_text()
    notebook = re.search(r"```python\n(import loopbench\n.*?)```", page, re.S)[1]
    script = "import shutil; assert not any(map(shutil.which, ('c++', 'clang++', 'g++', 'cc')))\n"
    printed = call(scripts / "python", "-c", script + notebook + "print(loopbench.__file__)", PATH=str(scripts))
    *lines, file = printed.splitlines()
    assert Path(file).is_relative_to(Path(folder).resolve()), file
    before, after = (float(line.split()[1]) for line in lines[:2])
    assert 0 < after < before, printed
    version = call(scripts / "loopbench", "--version").split()[1]
    assert wheel.name.startswith(f"loopbench-{version}-"), (wheel.name, version)
    call(scripts / "loopbench", "run", "quickstart", "--dry-run")  # the config is in the wheel
