#!/usr/bin/env bash
# Checks sentences of README.md by `compare --assert`; a sentence that is not shown is printed with what was measured
# (exit 1). They were stated after these results had been seen: new seeds or new routes would be the test.
# Usage: claims.sh [--data DIR] [QUICKSTART [LOOPBENCH]]. QUICKSTART is a folder with the results of quickstart (default:
# results/quickstart; computed if it has none), DIR has the LiDAR chains of configs/evidence.yaml (default:
# $LOOPBENCH_DATA; their sentences are skipped without it).
set -euo pipefail
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
data=${LOOPBENCH_DATA:-}
if [[ ${1:-} == --data ]]; then
  data=$2
  shift 2
fi
quickstart=${1:-$root/results/quickstart} loopbench=${2:-$root/run.sh}
lidar=$root/results/evidence/stores/evidence
failed=0

# check STORE FILTER SENTENCE
check() {
  if "$loopbench" compare "$1" --where "$2" --assert "$3" >/dev/null; then
    printf 'shown: %s (%s)\n' "$3" "$2"
  else
    failed=1
  fi
}

[[ -e $quickstart/results.sqlite ]] || "$loopbench" run "$root/configs/quickstart.yaml" --out "$quickstart" >/dev/null
check "$quickstart" times=dense,unit=m 'dual is at least 15 % below raw'
check "$quickstart" times=keyframes,unit=m 'dual is below two_pass'
# Closures are true and covariances right there: estimating both costs nothing.
check "$quickstart" times=dense,unit=m 'consensus is at most 2 % above pose_graph'
# Of the mean over the four sequences; nearly all of it is on the one with sparse keyframes.
check "$quickstart" times=dense,unit=m 'dual + dm_robust is below dual'
check "$quickstart" times=keyframes,unit=m 'dual + smoothing_spline is at most 1 % above dual'

if [[ -e $data/kitti/00/kiss_icp_open.txt ]]; then
  "$loopbench" run "$root/configs/evidence.yaml" --data "$data" --out "$lidar" --only ' / (dual|uniform)$' >/dev/null
  # Two methods, because seven routes can show nothing about five.
  check "$lidar" 'unit=m,method~^(dual|uniform)$' 'dual is at least 20 % below uniform'
else
  echo 'skipped: dual is at least 20 % below uniform on LiDAR chains (--data DIR with kitti/00/kiss_icp_open.txt)'
fi
exit $failed
