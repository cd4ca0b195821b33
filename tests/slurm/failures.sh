#!/usr/bin/env bash
# Random failures of a real Slurm cluster of four nodes on this machine, in rounds of up to ten. After each round the
# missing cells are run, by another submission or `run`, and the store must have the rows of an
# undisturbed `loopbench run`, except times.
# Usage: tests/slurm/failures.sh LOOPBENCH [SEED] [FAILURES] [CELLS]
# Prints a line per failure. Needs root and the packages slurm-wlm, munge and python3.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
loopbench=$(realpath "$1") seed=${2:-1} failures=${3:-100} cells=${4:-2000}
per_round=10 shards=8
# shellcheck source=tests/slurm/cluster.sh
source "$here/cluster.sh"
use_folder failures
disk='' is_full=0
RANDOM=$seed

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
YAML
printf '#SBATCH --time=5\n#SBATCH --mem=2048M\n' >"$folder/slurm.sh"

job_of() { sed -n "s/^.* shards: job \([0-9]*\), .*/\1/p" "$1/submit.txt"; }
jobs_of() { sed -n 's/^  squeue --jobs //p' "$1/submit.txt"; }

# Tasks that wait only because Slurm delays requeued ones by two minutes, or holds them if a node could not start them.
hasten() {
  local task reason
  while read -r task reason; do
    case $reason in
      BeginTime) scontrol update JobId="$task" StartTime=now 2>/dev/null || true ;;
      *held*) scontrol release "$task" 2>/dev/null || true ;;
    esac
  done < <(squeue --noheader --array --format='%i %r' 2>/dev/null)
}

# Also true while the controller does not answer.
has_jobs() {
  hasten
  local listed
  listed=$(squeue --noheader --format=%F 2>/dev/null) || return 0
  grep -qx -e "${1/,/\\|}" <<<"$listed"
}

# Processes of the jobs that run on a node, and their slurmstepd.
processes_of_node() {
  local process parent
  for process in $(pgrep -f "$loopbench|slurm_script"); do
    grep -qz "^SLURMD_NODENAME=$1\$" "/proc/$process/environ" 2>/dev/null || continue
    grep -qz "^SLURM_CONF=$SLURM_CONF\$" "/proc/$process/environ" 2>/dev/null || continue
    echo "$process"
    parent=$(awk '{ print $4 }' "/proc/$process/stat" 2>/dev/null) || continue
    [[ $(cat "/proc/$parent/comm" 2>/dev/null) == slurmstepd ]] && echo "$parent"
  done | sort -u
  return 0
}

# Number of a daemon of this cluster; false if there is none.
daemon_of() { pgrep -o -f "^$1 .*-f $SLURM_CONF"; }

kill_all() { kill -KILL "$@" 2>/dev/null || true; }

# Uses the disk of one shard up, or makes room again.
fill_disk() {
  local used
  ((!is_full)) && mountpoint -q "$disk" || return 1
  used=$(df --output=used --block-size=1K "$disk" | tail -n 1)
  mount -o "remount,size=$((used > 4 ? used : 4))k" "$disk" 2>/dev/null || return 1
  is_full=1
}
empty_disk() {
  is_full=0
  mount -o remount,size=64m "$disk"
}

restart_controller() {
  local i
  start_daemon "$cluster_folder/slurmctld.out" slurmctld -D -f "$SLURM_CONF"
  for ((i = 0; i < 100; ++i)); do scontrol ping 2>/dev/null | grep -q 'is UP' && break; sleep 0.1; done
}

# What an administrator does: a restarted controller otherwise asks its nodes minutes later which jobs they lost, and
# drains them if it has given the number of a forgotten job to another one.
repair_cluster() {
  local i
  scontrol reconfigure || true
  for i in 1 2 3 4; do scontrol update NodeName="n$i" State=RESUME 2>/dev/null || true; done
}

# Makes one failure of the submission in a folder and describes it in `what`. False: there was nothing to fail, for
# example because no task is running.
one_failure() {
  local out=$1 kind=$((RANDOM % 12)) choice=$RANDOM job running task node process i code=0
  job=$(job_of "$out")
  mapfile -t running < <(squeue --noheader --array --states=RUNNING --jobs="$job" --format='%K %N' 2>/dev/null)
  ((${#running[@]})) || ((kind == 8 || kind == 9)) || return 1
  ((${#running[@]})) && read -r task node <<<"${running[choice % ${#running[@]}]}"
  case $kind in
    0) what="cancel task $task"; scancel "${job}_$task" 2>/dev/null || return 1 ;;
    1) what="kill all processes of task $task"; scancel --full --signal=KILL "${job}_$task" 2>/dev/null || return 1 ;;
    2) what="requeue task $task"; scontrol requeue "${job}_$task" 2>/dev/null || return 1 ;;
    3) what="kill slurmd of $node, restart it"
      process=$(daemon_of "slurmd -D -N $node") || return 1
      kill_all "$process"
      sleep 0.5
      start_node "$node" ;;
    4 | 5) what="kill $node with its jobs, restart it"
      process=$(daemon_of "slurmd -D -N $node") || return 1
      # shellcheck disable=SC2046
      kill_all "$process" $(processes_of_node "$node")
      sleep 0.5
      start_node "$node" ;;
    6) what="drain $node, requeue its tasks"
      scontrol update NodeName="$node" State=DRAIN Reason=test 2>/dev/null || return 1
      for i in $(squeue --noheader --array --nodelist="$node" --jobs="$job" --format=%i 2>/dev/null); do
        scontrol requeue "$i" 2>/dev/null || true
      done
      sleep 1
      scontrol update NodeName="$node" State=RESUME 2>/dev/null || true ;;
    7) what="kill a process of a shard"
      mapfile -t running < <(pgrep -f "^$loopbench run .*$out")
      ((${#running[@]})) || return 1
      kill_all "${running[choice % ${#running[@]}]}" ;;
    8 | 9) what="kill a merge"
      "$loopbench" merge --add "$out"/shards/*/results.sqlite -o "$out" >/dev/null 2>&1 &
      process=$!
      sleep "0.0$((choice % 10))"
      # shellcheck disable=SC2046
      kill_all "$process" $(pgrep -f "^$loopbench merge .*$out")
      wait "$process" 2>/dev/null || code=$?
      ((code == 137)) || return 1 ;;
    10) what="fill the disk of shard 2"; fill_disk || return 1 ;;
    11) if ((choice % 2)); then
        what="kill slurmctld, restart it"
        process=$(daemon_of "slurmctld -D") || return 1
        kill_all "$process"
        restart_controller
      else
        what="cancel all"; scancel "${job}" 2>/dev/null || return 1
      fi ;;
  esac
}

# All cells are in the merged store.
is_complete() {
  [[ -f $1/results.sqlite ]] &&
    (($(python3 -c 'import sqlite3, sys; print(sqlite3.connect(sys.argv[1]).execute(
      "SELECT count(*) FROM cell WHERE position IS NOT NULL").fetchone()[0])' "$1/results.sqlite") == cells))
}

echo "== undisturbed run of $cells cells"
"$loopbench" run "$folder/sweep.yaml" --out "$folder/whole" >/dev/null
start_cluster "$folder/cluster" 4
count=0 round=0 submissions=0
while ((count < failures)); do
  round=$((round + 1)) last=$((count + per_round)) attempt=0
  ((last > failures)) && last=$failures
  out=$folder/round-$round
  disk=$out/shards/2-of-$shards
  mkdir -p "$disk"
  mount -t tmpfs -o size=64m tmpfs "$disk"
  while ((attempt == 0)) || ! is_complete "$out"; do
    attempt=$((attempt + 1))
    ((attempt <= 30)) || { echo "round $round is not complete after 30 submissions"; exit 1; }
    empty_disk
    if ((RANDOM % 3 == 0)) && [[ -f $out/results.sqlite ]]; then
      "$loopbench" run "$folder/sweep.yaml" --out "$out" >"$out/missing.txt" 2>&1 &
      process=$! code=0
      ((count >= last)) || { sleep "0.$((RANDOM % 10))"; kill_all "$process"; }
      wait "$process" 2>/dev/null || code=$?
      ((code == 137)) && count=$((count + 1)) && echo "round $round, failure $count: kill \`run\`"
      continue
    fi
    "$loopbench" submit "$folder/sweep.yaml" --array "$shards" --header "$folder/slurm.sh" --out "$out" \
      >"$out/submit.txt"
    submissions=$((submissions + 1)) jobs=$(jobs_of "$out") began=$SECONDS asked=$SECONDS
    while has_jobs "$jobs"; do
      ((SECONDS - asked < 30)) || { repair_cluster; asked=$SECONDS; }
      ((SECONDS - began < 300)) || { squeue; echo "round $round: the jobs do not end"; exit 1; }
      sleep "0.$((RANDOM % 10))"
      if ((count < last)) && one_failure "$out"; then
        count=$((count + 1))
        echo "round $round, failure $count: $what"
      fi
    done
  done
  "$loopbench" run "$folder/sweep.yaml" --out "$out" | grep -F "$cells of $cells cells done" | grep -F ' 0 failed' >/dev/null
  echo "round $round: $("$here/same_rows.py" "$loopbench" "$folder/whole" "$out" 2>/dev/null), $attempt attempts"
  umount -l "$disk"
  disk=''
  rm -rf "$out"
done
echo "slurm: $count failures in $round rounds and $submissions submissions, seed $seed;" \
  "each final store has the rows of the undisturbed run"
