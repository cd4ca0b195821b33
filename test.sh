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
done
