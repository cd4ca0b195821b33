#!/usr/bin/env bash
# ./run.sh          installs missing packages, builds, runs the default comparison
# ./run.sh ARGS...  the same setup, then `loopbench ARGS...`
# ./run.sh benchmark [FILTER [PLUGIN...]]  times methods, also those of plugins, solvers, smoothers and the evaluation;
#                                          FILTER: a regular expression of names
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$here/build/release
source "$here/cmake/setup.sh"
export LOOPBENCH_NAME=$0  # for the commands that the program prints

configure() { (cd "$here" && quietly cmake --preset release -DLOOPBENCH_BUILD_TESTS=OFF "$@"); }

# Reads the output of ninja: every ten seconds, prints what is left and how long it takes at the rate until now.
print_progress() {
  local line finished all elapsed left next=5
  while IFS= read -r line; do
    [[ $line =~ ^@([0-9]+)/([0-9]+)\ ([0-9]+) ]] || continue
    finished=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} elapsed=${BASH_REMATCH[3]}
    ((elapsed >= next && finished < all)) || continue
    next=$((elapsed + 10))
    left=$((elapsed * (all - finished) / finished))
    echo "loopbench: building, $((all - finished)) of $all steps left, about $((left / 60)) min $((left % 60)) s"
  done
}

# build_target NAME: prints the compiler's output only if it fails.
build_target() {
  local log code=0
  (sleep 5 &>/dev/null && echo "loopbench: building, because sources or packages are new" >&2) &
  local note=$!
  log=$(NINJA_STATUS='@%f/%t %e ' cmake --build "$build" --target "$1" 2>&1 | tee >(print_progress >&2)) || code=3
  kill "$note" 2>/dev/null || true
  ((code == 0)) || { grep -v '^@' <<<"$log" >&2; exit "$code"; }
}

if [[ ${1-} == benchmark ]]; then
  install_missing "${packages[@]}" "${benchmark_packages[@]}"
  configure -DLOOPBENCH_BENCHMARKS=ON
  build_target benchmark_programs
  filter=--benchmark_filter=${2-.}
  for subject in methods chains smoothers evaluation; do
    program=$build/tests/benchmarks/benchmark_$subject plugins=()
    [[ $subject == methods ]] && plugins=("${@:3}")
    names=$("$program" "$filter" --benchmark_list_tests "${plugins[@]}" 2>/dev/null) || true
    [[ -z $names ]] || "$program" "$filter" "${plugins[@]}"
  done
  exit
fi

needed=("${packages[@]}")
if (($#)); then
  needed+=("${sandbox_packages[@]}")
else
  set -- run "$here/configs/quickstart.yaml"
fi
install_missing "${needed[@]}"
case "$* " in
  plot\ * | traj\ plot\ * | eval\ *--plot[\ =]* | eval\ *--report[\ =]*)
    install_missing "${plot_packages[@]}" ;;
esac
[[ -f $build/build.ninja && ${#installed[@]} -eq 0 ]] || configure
build_target loopbench

grep -q '^LOOPBENCH_.*-NOTFOUND$' "$build/CMakeCache.txt" || exec "$build/loopbench" "$@"
# Exit code 4: the config reads images, and this build was made without the libraries for them.
code=0
"$build/loopbench" "$@" || code=$?
((code == 4)) || exit "$code"
install_missing "${image_packages[@]}"
configure
build_target loopbench
exec "$build/loopbench" "$@"
