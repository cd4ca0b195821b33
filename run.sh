#!/usr/bin/env bash
# ./run.sh          installs what is missing, builds, runs the default comparison
# ./run.sh ARGS...  the same set-up, then `loopbench ARGS...`
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/cmake/setup.sh"

build=$here/build/release
if [[ ! -f $build/build.ninja ]]; then
  (cd "$here" && cmake --preset release >&2)
fi
if [[ ! -x $build/loopbench ]]; then
  echo "loopbench: building; the first time takes a few minutes" >&2
  cmake --build "$build" --target loopbench >&2
else
  # Quiet when there is nothing to do or all goes well; everything when it does not.
  log=$(cmake --build "$build" --target loopbench 2>&1) || { echo "$log" >&2; exit 3; }
fi

(($#)) || set -- run "$here/configs/quickstart.yaml"
exec "$build/loopbench" "$@"
