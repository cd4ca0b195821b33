#!/usr/bin/env bash
# ./test.sh            set-up, build, all tests: release, then ASan+UBSan, then TSan
# ./test.sh PRESET...  only these (release, debug, tsan, clang)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

(($#)) || set -- tsan debug release
for preset in "$@"; do
  echo "== $preset"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  ctest --preset "$preset"
done
