#!/usr/bin/env bash
# tests/fuzz/run.sh HOURS [TARGET...]   fuzzes all targets, or these, for equal times, two at a time, HOURS in all
# Corpora are kept in build/corpus, logs in build/corpus/<target>.log, findings in build/corpus/<target>-crash-*.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
(($#)) || { sed -n 2,3p "${BASH_SOURCE[0]}"; exit 2; }
hours=$1
shift
cmake --preset fuzz -DLOOPBENCH_BUILD_TESTS=ON >/dev/null
cmake --build --preset fuzz
if (($# == 0)); then
  for program in build/fuzz/tests/fuzz/fuzz_*; do
    name=${program##*/fuzz_}
    [[ $name == *.* || $name == random || $name == corpus* ]] || set -- "$@" "$name"
  done
fi
seconds=$(awk -v h="$hours" -v n=$# 'BEGIN { printf "%d", h * 3600 * 2 / n }')

fuzz_one() {
  mkdir -p "build/corpus/$1"
  local seeds=(tests/data/good tests/data/bad)
  [[ -d tests/data/fuzz/$1 ]] && seeds+=("tests/data/fuzz/$1")
  [[ $1 == report ]] && seeds+=(tests/data/fuzz/store)
  # Short texts run ten times as often as long ones, and contain as many kinds of faults.
  local most=4096
  [[ $1 == store || $1 == report || $1 == bag || $1 == image ]] && most=65536
  nice -n 15 "build/fuzz/tests/fuzz/fuzz_$1" -max_total_time="$2" -max_len="$most" -rss_limit_mb=4096 -timeout=30 \
    -print_final_stats=1 -artifact_prefix="build/corpus/$1-" "build/corpus/$1" "${seeds[@]}" \
    >"build/corpus/$1.log" 2>&1 || echo "$1: finding, see build/corpus/$1.log"
  echo "$1: $(sed -n 's/^stat::number_of_executed_units: *//p' "build/corpus/$1.log") executions"
}
export -f fuzz_one
# A fifth faster. Without them, a finding's report also says where its memory was allocated.
export ASAN_OPTIONS=malloc_context_size=0:quarantine_size_mb=16:allocator_release_to_os_interval_ms=-1
printf '%s\n' "$@" | xargs -P 2 -I{} bash -c "fuzz_one {} $seconds"
