#!/usr/bin/env bash
# Sweeps on a real Slurm cluster of four nodes on this machine: an undisturbed submission, then one with random
# failures. Both must give the rows of `loopbench run`, except times.
# Usage: tests/slurm/run.sh LOOPBENCH [SEED] [FAILURES] [CELLS]
# Needs root and the packages slurm-wlm, munge and python3.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
loopbench=$(realpath "$1") seed=${2:-1} failures=${3:-5} cells=${4:-400}
# shellcheck source=tests/slurm/cluster.sh
source "$here/cluster.sh"
folder=$(mktemp -d /tmp/loopbench-slurm.XXXXXX)
finish() {
  local code=$?
  stop_cluster
  mountpoint -q "$folder/failures/shards/2-of-8" && umount "$folder/failures/shards/2-of-8"
  ((code)) && { echo "failed; the files are in $folder"; exit "$code"; }
  rm -rf "$folder"
}
trap finish EXIT
RANDOM=$seed

# The rows of a store without times, in a fixed order.
rows() {
  "$loopbench" export "$1" -o "$2.csv" >/dev/null
  /usr/bin/python3 - "$2.csv" <<'PYTHON'
import csv, sys
with open(sys.argv[1], newline="") as file:
    rows = list(csv.DictReader(file))
kept = [tuple(v for k, v in row.items() if k != "milliseconds") for row in rows if row["metric"] != "time"]
print(*sorted(map(repr, kept)), sep="\n")
PYTHON
}

expect_same_rows() {
  rows "$folder/whole" "$folder/whole-rows" >"$folder/expected.txt"
  rows "$1" "$folder/found-rows" >"$folder/found.txt"
  cmp "$folder/expected.txt" "$folder/found.txt" || { echo "$1: other rows than the undisturbed run"; return 1; }
}

# Waits until no job of the submission is left; false after the given seconds.
jobs_end() {
  local i
  for ((i = 0; i < $2; ++i)); do
    [[ -z $(squeue --noheader --jobs="$1" 2>/dev/null) ]] && return 0
    sleep 1
  done
  return 1
}

job_of() { sed -n "s/^$2 //p" "$1/submission.txt"; }

cat >"$folder/sweep.yaml" <<YAML
datasets:
  - {dataset: simulated, path: room, keyframes: 40, seed: 1, label: "room; \$(false) 'a'"}
  - {dataset: simulated, path: office, keyframes: 40, seed: 2, label: office}
methods: [raw, uniform, elch, two_pass, dual]
metrics: [ate, rpe]
times: keyframes
traces: false
limits: {seconds: 20, memory: 1GiB}
repeats: $((cells / 10))
cluster: {array: 8, time: "5", memory: 2GiB, signal: 30}
YAML

echo "== undisturbed run of $cells cells"
"$loopbench" run "$folder/sweep.yaml" --out "$folder/whole" >/dev/null
start_cluster "$folder/cluster" 4
echo "== submission without failures"
"$loopbench" submit "$folder/sweep.yaml" --out "$folder/calm" >/dev/null
timeout 900 "$loopbench" watch "$folder/calm" --every 2 | tail -n 2
expect_same_rows "$folder/calm"

one_failure() {
  local job=$1 node=n$((1 + RANDOM % 4)) task=$((1 + RANDOM % 8)) process
  case $((RANDOM % 5)) in
    0) echo "cancel task $task"; scancel "${job}_$task" || true ;;
    1) echo "kill slurmd of $node"
      process=$(pgrep -f "^slurmd -D -N $node -f $SLURM_CONF" | head -n 1) || true
      [[ -z $process ]] || kill -KILL "$process"
      sleep 1
      start_node "$node" ;;
    2) echo "drain $node and requeue a task"
      scontrol update NodeName="$node" State=DRAIN Reason=test || true
      scontrol requeue "${job}_$task" 2>/dev/null || true
      sleep 1
      scontrol update NodeName="$node" State=RESUME || true ;;
    3) echo "kill the shards and merges that are running"
      for process in $(pgrep -f "^$loopbench (run|merge) .*$folder/failures" | shuf -n 1 --random-source=<(yes "$RANDOM")); do
        kill -KILL "$process" 2>/dev/null || true
      done ;;
    4) echo "full disk of shard 2"
      mkdir -p "$folder/failures/shards/2-of-8"
      if ! mountpoint -q "$folder/failures/shards/2-of-8" &&
        mount -t tmpfs -o size=200k tmpfs "$folder/failures/shards/2-of-8" 2>/dev/null; then
        sleep 3
        umount -l "$folder/failures/shards/2-of-8"
      fi ;;
  esac
}

echo "== submission with $failures failures, seed $seed"
count=0
for ((attempt = 1; attempt <= failures + 20; ++attempt)); do
  "$loopbench" submit "$folder/sweep.yaml" --out "$folder/failures" >/dev/null
  job=$(job_of "$folder/failures" job) merge=$(job_of "$folder/failures" merge)
  while ((count < failures)) && [[ -n $(squeue --noheader --jobs="$job,$merge" 2>/dev/null) ]]; do
    sleep "0.$((RANDOM % 10))"
    one_failure "$job"
    count=$((count + 1))
  done
  jobs_end "$job,$merge" 300 || scancel "$job" "$merge"
  if ((count >= failures)) && [[ -f $folder/failures/results.sqlite ]] &&
    "$loopbench" run "$folder/sweep.yaml" --out "$folder/failures" --missing --dry-run | grep -q '^0 cells'; then
    break
  fi
done
expect_same_rows "$folder/failures"
echo "slurm: $count failures in $attempt submissions; all rows equal those of the undisturbed run"
