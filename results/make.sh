#!/usr/bin/env bash
# Makes the numbers behind the guide (README.md) from one command, in at most 20 minutes on two cores: evidence, false
# closures, the sentences of claims.sh, and whether each number of the guide is still on a page.
# Usage: make.sh --data DIR [--exam DIR] [LOOPBENCH]. With --exam, DIR/exam has unseen recordings in the folders of
# configs/held_out.yaml (blocks without a folder are left out, trusted is needed); its results go to results/exam.
# The picture of the README: ./run.sh run configs/quickstart.yaml && ./run.sh report results/quickstart -o report.html
# chromium --headless --hide-scrollbars --window-size=1280,925 --screenshot=results/quickstart/report.png report.html
set -euo pipefail
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
data=${LOOPBENCH_DATA:-} exam=''
while [[ ${1:-} == --* ]]; do
  case $1 in
    --data) data=$2 ;;
    --exam) exam=$(realpath "$2") ;;
    *) sed -n 's/^# Usage: //p' "$0" >&2; exit 2 ;;
  esac
  shift 2
done
loopbench=$(realpath "${1:-$root/run.sh}")

if [[ -n $exam ]]; then
  config=$root/results/held_out.yaml
  trap 'rm -f "$config"' EXIT
  awk -v dir="$exam/" '
    function flush() { if (item != "" && !is_missing) printf "%s", item; item = ""; is_missing = 0 }
    /^  - |^[a-z]/ { flush() }
    match($0, /exam\/[a-z]+/) && system("test -d \"" dir substr($0, RSTART, RLENGTH) "\"") { is_missing = 1 }
    { item = item $0 "\n" }
    END { flush() }' "$root/configs/held_out.yaml" >"$config"
  "$loopbench" run "$config" --data "$exam" --out "$root/results/exam" --failed-cells-ok
  "$root/results/evidence/judge.py" "$root/results/exam" --program "$loopbench"
  for loops in "$exam"/exam/{doubtful,few}/*/loops.txt; do
    [[ ! -e $loops ]] || "$loopbench" loops "${loops%loops.txt}odometry.txt" --loops "$loops" || true
  done
fi
[[ -n $data ]] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
"$root/results/evidence/make.py" --data "$data" --program "$loopbench"
"$root/results/claims.sh" --data "$data" "$root/results/evidence/stores/quickstart" "$loopbench"
numbers() { grep -ohE '[0-9]+\.[0-9]+' "$@" | sort -u; }
lost=$(comm -23 <(grep '^|' "$root/results/README.md" | numbers) <(numbers "$root"/results/{evidence,methods}/*.md))
[[ -z $lost ]] || { echo "results/README.md: on no page any more: $lost" >&2; exit 1; }
