"""Build backend of the Python package (PEP 517), of the standard library alone.

Builds preset `release` and packs what CMake installs as component `wheel`. With
`--config-settings build-dir=FOLDER`, packs that build as it is. With `libraries=inside`, the wheel also
contains the libraries that it links and their licences, and runs on any Linux with the C library of
this system or a later one; needs patchelf.
"""

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
TARGETS = ("loopbench", "loopbench_python")


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Name of the folder, with METADATA."""
    project = tomllib.loads((SOURCE / "pyproject.toml").read_text())["project"]
    version = re.search(r"project\(loopbench VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
    info = f"{project['name']}-{version}.dist-info"
    Path(metadata_directory, info).mkdir()
    Path(metadata_directory, info, "METADATA").write_text("".join(f"{line}\n" for line in (
        "Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
        f"Summary: {project['description']}", f"License: {project['license']['text']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {each}" for each in project["dependencies"]))))
    return info


# Every Linux has these (PEP 600).
SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|mvec|dl|rt|pthread|gcc_s|stdc\+\+))\.so")


def _include_libraries(tree, info):
    """Copies what the program and the module link, and where both search for it.

    Libraries search where those that need them do, if these have an RPATH: only the program and the module change.
    """
    data = tree / f"{info.removesuffix('.dist-info')}.data"
    program = data / "scripts/loopbench"
    module = next((tree / "loopbench").glob("_core.*.so"))
    folder = data / "data/lib/loopbench"
    folder.mkdir(parents=True)
    found = {}
    for file in (program, module):
        listing = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
        found |= dict(re.findall(r"(\S+) => (/\S+)", listing))
    for name, path in found.items():
        if not SYSTEM.match(name):
            shutil.copy(path, folder / name)
            _copy_licence(Path(path).resolve().name, tree / info / "licenses")
    # In PREFIX/bin, PREFIX/lib/pythonX.Y/site-packages/loopbench, and where `pip install --target` puts it.
    for file, path in ((program, "$ORIGIN/../lib/loopbench"),
                       (module, "$ORIGIN/../../../loopbench:$ORIGIN/../lib/loopbench")):
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", path, file], check=True)


def _copy_licence(library, folder):
    """Of the Debian package that has a file of this name."""
    owner = subprocess.run(["dpkg", "-S", f"*/{library}"], capture_output=True, text=True, check=True).stdout
    package = owner.split(":")[0]
    folder.mkdir(exist_ok=True)
    shutil.copy(f"/usr/share/doc/{package}/copyright", folder / f"{package}.txt")


def _tag(tree, platform):
    """Of the interpreter that the module is compiled for."""
    module = next((tree / "loopbench").glob("_core.cpython-*.so"), None)
    if module is None:
        raise SystemExit("no compiled module: expected python3-dev, python3-numpy and pybind11-dev")
    version = "cp" + re.findall(r"cpython-(\d+)", module.name)[0]
    return f"{version}-{version}-" + re.sub(r"[-.]", "_", platform)


def _pack(tree, wheel, info):
    """Files with fixed dates, so that equal builds give equal wheels; RECORD is the last."""
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as out:
        for file in sorted(path for path in tree.rglob("*") if path.is_file()):
            name, data = str(file.relative_to(tree)), file.read_bytes()
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o100755 if file.parent.name == "scripts" else 0o100644) << 16
            out.writestr(entry, data, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}\n")
        record.append(f"{info}/RECORD,,\n")
        out.writestr(zipfile.ZipInfo(f"{info}/RECORD"), "".join(record))


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    build = settings.get("build-dir")
    if build is None:
        build = SOURCE / "build/release"
        # By PYTHONPATH, pip hides the interpreter's packages, of which CMake needs numpy.
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        tests = () if (build / "CMakeCache.txt").exists() else ("-DLOOPBENCH_BUILD_TESTS=OFF",)
        subprocess.run(["cmake", "--preset", "release", *tests], cwd=SOURCE, env=environment, check=True)
        subprocess.run(["cmake", "--build", build, "--target", *TARGETS], env=environment, check=True)
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        subprocess.run(["cmake", "--install", build, "--prefix", tree, "--component", "wheel", "--strip"],
                       check=True, stdout=subprocess.DEVNULL)
        info = prepare_metadata_for_build_wheel(tree)
        platform = sysconfig.get_platform()
        if settings.get("libraries") == "inside":
            _include_libraries(tree, info)
            # glibc 2.36 -> manylinux_2_36_x86_64
            platform = f"manylinux_{os.confstr('CS_GNU_LIBC_VERSION').split()[1]}_{os.uname().machine}"
        tag = _tag(tree, platform)
        (tree / info / "WHEEL").write_text(
            f"Wheel-Version: 1.0\nGenerator: loopbench\nRoot-Is-Purelib: false\nTag: {tag}\n")
        wheel = f"{Path(info).stem}-{tag}.whl"
        _pack(tree, Path(wheel_directory) / wheel, info)
    return wheel
