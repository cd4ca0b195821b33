#!/usr/bin/env bash
# ./test.sh            setup, optimised build, tests
# ./test.sh all        also projects outside the tree, benchmarks, studies, commands of pages, configs/images.yaml, the
#                      fuzz corpus, LaTeX, style, tests under ASan and UBSan, and threaded code under TSan; CI runs that
# ./test.sh NAME...    only these (lint, package, slurm, colcon, or a preset: release, debug, tsan, gcc)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh
(($#)) || set -- release
extras=OFF
[[ $* == all ]] && extras=ON && set -- lint tsan debug release
[[ $extras == ON ]] || export GTEST_FILTER='-*ShippedConfig.*/images'  # a minute of image processing
install_missing "${packages[@]}" "${sandbox_packages[@]}" "${image_packages[@]}" "${plot_packages[@]}" \
  "${python_packages[@]}" "${benchmark_packages[@]}" "${test_packages[@]}"
[[ " $* " == *" gcc "* ]] && install_missing g++
[[ " $* " == *" debug "* || " $* " == *" tsan "* ]] && install_missing "${sanitizer_packages[@]}"

# Runs shellcheck for all scripts, clang-format for all files, and clang-tidy for all but benchmarks, studies
# and fuzzing; each library and program as one source. `all` leaves out the tests, where clang-tidy checks names only.
lint() {
  shellcheck -x ./*.sh cmake/*.sh cmake/package/*.sh datasets/*.sh results/*.sh tests/*.sh tests/*/*.sh .ci/*
  find datasets methods metrics harness include results tests -name '*.[ch]pp' -print0 | xargs -0 clang-format --dry-run --Werror
  cmake --preset lint -DLOOPBENCH_BUILD_TESTS=ON -DLOOPBENCH_TEST_ALL=ON >/dev/null
  # Long ones first, so that no processor waits at the end.
  local unchecked='\(benchmarks\|fuzz\|scale\|studies\)/'
  [[ $extras == ON ]] && unchecked=''
  { find build/lint -path '*/Unity/*.cxx' -not -regex ".*/tests/$unchecked.*" -printf '%s %p\n'
    printf '0 %s\n' "$PWD"/datasets/{compressed/decompress,columns/geodetic}.cpp; } |  # not in a batch
    sort -rn | cut -d ' ' -f 2 |
    xargs -P "$(nproc)" -n 1 clang-tidy -p build/lint --quiet 2>/dev/null
}

counts=()
for preset in "$@"; do
  echo "== $preset"
  if [[ $preset == lint ]]; then
    install_missing "${lint_packages[@]}"
    if [[ $(clang-format --version) != *" 14."* ]]; then
      counts+=("lint: skipped, needs clang-format and clang-tidy 14 of Debian 12")
      continue
    fi
    lint
    counts+=("lint: clean")
    continue
  fi
  if [[ $preset == package ]]; then
    cmake/package/release.sh build/dist
    cmake/package/test_package.sh build/dist
    counts+=("package: package, wheel and sources run in bare roots of Debian 12 and 13")
    continue
  fi
  if [[ $preset == colcon ]]; then
    install_missing "${colcon_packages[@]}"
    tests/plugin/colcon.sh
    counts+=("colcon: a workspace with a package that uses loopbench")
    continue
  fi
  if [[ $preset == slurm ]]; then
    # Not part of `all`: it starts the daemons of a cluster, which needs root.
    install_missing "${slurm_packages[@]}"
    cmake --preset release >/dev/null
    cmake --build build/release --target loopbench
    tests/slurm/run.sh build/release/loopbench
    counts+=("slurm: a sweep on four nodes, with and without failures")
    continue
  fi
  cmake --preset "$preset" -DLOOPBENCH_BUILD_TESTS=ON -DLOOPBENCH_TEST_ALL=$extras >/dev/null
  cmake --build --preset "$preset"
  ctest --preset "$preset"  # debug leaves out minutes of statistics, browsers and killed sweeps: release has them
  log=build/$preset/Testing/Temporary/LastTest.log
  sed -n 's/^\[  SKIPPED \] \(.*\) (.* ms)$/skipped: \1/p' "$log" | sort -u
  counts+=("$preset: $(awk '
    /^\[  PASSED  \] [0-9]+ test/ { passed += $4 }
    /^\[  SKIPPED \] [0-9]+ test/ { skipped += $4 }
    /^Test Passed/ { ++programs }
    END { printf "%d cases passed, %d skipped, in %d programs", passed, skipped, programs }' "$log")")
  if [[ $preset == release ]]; then
    # The default comparison against its baseline: numbers that got worse fail here.
    loopbench=build/release/loopbench checked=build/release/check
    $loopbench run configs/quickstart.yaml --out $checked >/dev/null
    $loopbench check $checked --baseline results/reference/quickstart.json --junit $checked/junit.xml
    results/claims.sh $checked $loopbench
    tests/documented_outputs.sh $loopbench . $checked
    if [[ $extras == ON ]]; then
      tests/documented_runs.sh $loopbench . $checked
      tests/latex.sh $loopbench $checked
    else
      echo "skipped: commands of pages, configs/images.yaml, fuzz corpus, LaTeX (./test.sh all)"
    fi
  fi
done
[[ $* == "tsan debug release" || $* == "lint tsan debug release" ]] && counts+=("slurm: skipped, run ./test.sh slurm")
printf 'loopbench: all tests passed\n'
printf '  %s\n' "${counts[@]}"
