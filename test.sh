#!/usr/bin/env bash
# ./test.sh            set-up, build, all tests: threads under TSan, all under ASan+UBSan, all optimised
# ./test.sh PRESET...  only these (release, debug, tsan, clang)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
(($#)) || set -- tsan debug release
[[ " $* " == *" clang "* ]] && more_packages=(clang-14)
source cmake/setup.sh

for preset in "$@"; do
  echo "== $preset"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  ctest --preset "$preset"
  sed -n 's/^\[  SKIPPED \] \(.*\) (.* ms)$/skipped: \1/p' "build/$preset/Testing/Temporary/LastTest.log" | sort -u
  if [[ $preset == release ]]; then
    # The default comparison against its baseline: numbers that got worse fail here.
    loopbench=build/release/loopbench checked=build/release/check
    $loopbench run configs/quickstart.yaml --out $checked >/dev/null
    $loopbench check $checked --baseline results/reference/quickstart.json --junit $checked/junit.xml
  fi
done
