#!/usr/bin/env bash
# ./run.sh          installs missing packages, builds, runs the default comparison
# ./run.sh ARGS...  the same setup, then `loopbench ARGS...`
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$here/build/release
source "$here/cmake/setup.sh"
export LOOPBENCH_NAME=$0  # for the commands that the program prints
(($#)) || set -- run "$here/configs/quickstart.yaml"

configure() { (cd "$here" && quietly cmake --preset release -DLOOPBENCH_BUILD_TESTS=OFF); }

build_program() {
  if [[ ! -x $build/loopbench ]]; then
    echo "loopbench: building; the first time takes about 4 minutes on two cores" >&2
    cmake --build "$build" --target loopbench >&2
  else
    quietly cmake --build "$build" --target loopbench || exit 3
  fi
}

install_missing "${packages[@]}" "${compression_packages[@]}"
case "$* " in
  plot\ * | traj\ plot\ * | eval\ *--plot[\ =]* | eval\ *--report[\ =]*)
    install_missing "${plot_packages[@]}" ;;
  get\ *) install_missing "${get_packages[@]}" ;;
esac
[[ -f $build/build.ninja ]] || configure
build_program

grep -q '^LOOPBENCH_OPENCV_INCLUDE:PATH=/' "$build/CMakeCache.txt" && exec "$build/loopbench" "$@"
code=0
"$build/loopbench" "$@" || code=$?
((code == 4)) || exit "$code"
# Exit code 4: the config reads images, and this build was made without OpenCV.
install_missing "${image_packages[@]}"
configure
build_program
exec "$build/loopbench" "$@"
