#!/usr/bin/env bash
# Sweeps on a real Slurm cluster of four nodes on this machine: an undisturbed submission with staged inputs, one that
# is cancelled and continued, and submissions with random failures (failures.sh). All must give the rows of
# `loopbench run`, except times.
# Usage: tests/slurm/run.sh LOOPBENCH [SEED] [FAILURES] [CELLS]
# Needs root and the packages slurm-wlm, munge and python3.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
loopbench=$(realpath "$1") seed=${2:-1} failures=${3:-10} cells=${4:-400}
# shellcheck source=tests/slurm/cluster.sh
source "$here/cluster.sh"
use_folder slurm

expect_same_rows() { "$here/same_rows.py" "$loopbench" "$folder/whole" "$1" 2>/dev/null; }

queued() { squeue --noheader --format=%T; }

cat >"$folder/sweep.yaml" <<YAML
datasets:
  - {dataset: simulated, path: room, keyframes: 40, seed: 1, label: "room; \$(false) 'a'"}
  - {dataset: simulated, path: office, keyframes: 40, seed: 2, label: office}
  - {dataset: trajectory, estimate: golden/est_drift.txt, reference: golden/gt.txt, label: files,
     keyframes: {rule: every, value: 5}, closures: {source: reference, max: 4, radius: 4}}
methods: [raw, uniform, elch, two_pass, dual]
metrics: [ate, rpe]
times: keyframes
traces: false
limits: {seconds: 20, memory: 1GiB}
repeats: $((cells / 10))
cluster: {array: 8, time: "5", memory: 2GiB, signal: 30, stage: $folder/node}
YAML
export LOOPBENCH_DATA=$here/../data

echo "== undisturbed run of $cells cells"
"$loopbench" run "$folder/sweep.yaml" --out "$folder/whole" >/dev/null 2>&1
start_cluster "$folder/cluster" 4
echo "== submission without failures"
"$loopbench" submit "$folder/sweep.yaml" --out "$folder/calm" >/dev/null
found=$("$loopbench" submit "$folder/sweep.yaml" --out "$folder/calm" 2>&1) && { echo "submitted twice"; exit 1; }
grep -q 'have not ended' <<<"$found"
timeout 900 "$loopbench" watch "$folder/calm" --every 2 | tail -n 2
expect_same_rows "$folder/calm"
(($(find "$folder/node" -name '*.txt' | wc -l) == 2)) || { echo "the inputs were not staged"; exit 1; }

echo "== cancelled submission"
"$loopbench" submit "$folder/sweep.yaml" --out "$folder/cancelled" >/dev/null
for ((i = 0; i < 100; ++i)); do queued | grep -q RUNNING && break; sleep 0.1; done
sleep 1
"$loopbench" cancel "$folder/cancelled"
for ((i = 0; i < 40; ++i)); do [[ -n $(queued) ]] || break; sleep 1; done
sleep 3
[[ -z $(queued) ]] || { echo "cancelled jobs are back:"; squeue; exit 1; }
"$loopbench" submit "$folder/sweep.yaml" --out "$folder/cancelled" >/dev/null
timeout 900 "$loopbench" watch "$folder/cancelled" --every 2 | tail -n 1
expect_same_rows "$folder/cancelled"
stop_cluster

"$here/failures.sh" "$loopbench" "$seed" "$failures" "$cells"
