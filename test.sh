#!/usr/bin/env bash
# ./test.sh            setup, optimised build, all tests
# ./test.sh all        also all tests under ASan and UBSan, threaded code under TSan
# ./test.sh PRESET...  only these (release, debug, tsan, clang)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh
(($#)) || set -- release
[[ $* == all ]] && set -- tsan debug release
install_missing "${packages[@]}" "${image_packages[@]}" "${plot_packages[@]}" "${test_packages[@]}"
[[ " $* " == *" clang "* ]] && install_missing clang-14

counts=()
for preset in "$@"; do
  echo "== $preset"
  cmake --preset "$preset" -DLOOPBENCH_BUILD_TESTS=ON >/dev/null
  cmake --build --preset "$preset"
  ctest --preset "$preset"
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
  fi
done
printf 'loopbench: all tests passed\n'
printf '  %s\n' "${counts[@]}"
