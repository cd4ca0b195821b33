#!/usr/bin/env bash
# ./run.sh          installs missing packages, builds, runs the default comparison
# ./run.sh ARGS...  the same setup, then `loopbench ARGS...`
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$here/build/release
source "$here/cmake/setup.sh"
export LOOPBENCH_NAME=$0  # for the commands that the program prints
needed=("${packages[@]}")
if (($#)); then
  needed+=("${sandbox_packages[@]}")
else
  set -- run "$here/configs/quickstart.yaml"
fi

configure() { (cd "$here" && quietly cmake --preset release -DLOOPBENCH_BUILD_TESTS=OFF); }

build_program() {
  if [[ ! -x $build/loopbench ]]; then
    echo "loopbench: building; the first time takes about 4 minutes on two cores" >&2
    cmake --build "$build" --target loopbench >&2
  else
    (sleep 5 &>/dev/null && echo "loopbench: building again, because sources or packages changed" >&2) &
    local note=$! code=0
    quietly cmake --build "$build" --target loopbench || code=3
    kill "$note" 2>/dev/null || true
    ((code == 0)) || exit "$code"
  fi
}

install_missing "${needed[@]}"
case "$* " in
  plot\ * | traj\ plot\ * | eval\ *--plot[\ =]* | eval\ *--report[\ =]*)
    install_missing "${plot_packages[@]}" ;;
esac
[[ -f $build/build.ninja ]] || configure
build_program

grep -q '^LOOPBENCH_.*-NOTFOUND$' "$build/CMakeCache.txt" || exec "$build/loopbench" "$@"
# Exit code 4: a file is compressed or has latitudes, or the config reads images, and this build was made without the
# libraries for it.
code=0
"$build/loopbench" "$@" || code=$?
for group in compression geodetic image; do
  ((code == 4)) || exit "$code"
  declare -n more=${group}_packages
  install_missing "${more[@]}"
  configure
  build_program
  code=0
  "$build/loopbench" "$@" || code=$?
done
exit "$code"
