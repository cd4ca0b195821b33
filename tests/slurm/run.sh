#!/usr/bin/env bash
# Sweeps on a real Slurm cluster of four nodes on this machine: an undisturbed submission, one that
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

submit() { "$loopbench" submit "$folder/sweep.yaml" --array 8 --header "$folder/slurm.sh" --out "$1"; }

wait_for_jobs() {
  local i
  for ((i = 0; i < 900; ++i)); do [[ -n $(queued) ]] || return 0; sleep 1; done
  squeue
  exit 1
}

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
YAML
printf '#SBATCH --time=5\n#SBATCH --mem=2048M\nexport FROM_HEADER=1\n' >"$folder/slurm.sh"
export LOOPBENCH_DATA=$here/../data

echo "== undisturbed run of $cells cells"
"$loopbench" run "$folder/sweep.yaml" --out "$folder/whole" >/dev/null 2>&1
start_cluster "$folder/cluster" 4
echo "== submission without failures"
submit "$folder/calm"
wait_for_jobs
expect_same_rows "$folder/calm"

echo "== cancelled submission"
jobs=$(submit "$folder/cancelled" | sed -n 's/^  squeue --jobs //p')
for ((i = 0; i < 100; ++i)); do queued | grep -q RUNNING && break; sleep 0.1; done
sleep 1
scancel "${jobs%,*}" "${jobs#*,}"
wait_for_jobs
submit "$folder/cancelled"
wait_for_jobs
expect_same_rows "$folder/cancelled"
stop_cluster

"$here/failures.sh" "$loopbench" "$seed" "$failures" "$cells"
