#!/usr/bin/env bash
# action.sh CONFIG FOLDER [BASELINE] [DATA]: runs CONFIG, checks it against BASELINE, and writes report.html,
# comment.md (summary table, verdicts, result of the check), badge.svg and the results into FOLDER. comment.md has at most
# 60,000 bytes, because CI systems reject longer comments; summary.md, errors.txt and check.txt are complete. Exits with
# the code of the run, or with that of the check if the run succeeded. LOOPBENCH names another program.
set -euo pipefail
config=$1 folder=$2 baseline=${3:-} data=${4:-}
loopbench=${LOOPBENCH:-loopbench}
mkdir -p "$folder"
arguments=()
[[ -n $data ]] && arguments=(--data "$data")

# shortened MOST FILE: standard input up to MOST bytes, in whole lines. FILE has all of it.
shortened() {
  LC_ALL=C awk -v most="$1" -v file="$2" '
    (bytes += length($0) + 1) <= most { print; next }
    !is_full { is_full = 1; printf "\n(shortened: %s in the artifact is complete)\n", file }'
}

ran=0
"$loopbench" run "$config" --out "$folder/results" "${arguments[@]}" >"$folder/summary.md" 2>"$folder/errors.txt" ||
  ran=$?
checked=0
if [[ -n $baseline && -e $folder/results/results.sqlite ]]; then
  "$loopbench" check "$folder/results" --baseline "$baseline" --markdown "$folder/check.md" \
    --junit "$folder/junit.xml" >"$folder/check.txt" 2>&1 || checked=$?
fi
if [[ -e $folder/results/results.sqlite ]]; then
  "$loopbench" report "$folder/results" -o "$folder/report.html" >/dev/null || true
fi
{
  echo "## loopbench: $config"
  echo
  sed '/^next:$/,$d' "$folder/summary.md" | shortened 24000 summary.md
  if [[ -s $folder/errors.txt ]]; then
    printf '\n```\n'
    shortened 4000 errors.txt <"$folder/errors.txt"
    printf '```\n'
  fi
  if [[ -s $folder/check.md ]]; then
    printf '\n### Comparison with %s\n\n' "$baseline"
    shortened 30000 check.txt <"$folder/check.md"
  elif [[ -s $folder/check.txt ]]; then
    printf '\n### Comparison with %s\n\n```\n' "$baseline"
    shortened 30000 check.txt <"$folder/check.txt"
    printf '```\n'
  fi
  printf '\nThe report is attached to this run: loopbench-report.\n'
} >"$folder/comment.md"
cat "$folder/comment.md"

# badge TEXT COLOUR
badge() {
  cat <<END
<svg xmlns="http://www.w3.org/2000/svg" width="150" height="20" role="img" aria-label="loopbench: $1">
<title>loopbench: $1</title><rect width="150" height="20" rx="3" fill="#444"/><rect x="75" width="75" height="20" rx="3" fill="$2"/>
<g fill="#fff" text-anchor="middle" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11"><text x="38" y="14">loopbench</text><text x="112" y="14">$1</text></g>
</svg>
END
}
case $ran$checked$baseline in
  00?*) badge passed "#1a7f37" ;;
  00) badge "no baseline" "#666" ;;
  01*) badge regressions "#b35900" ;;
  *) badge failed "#c62828" ;;
esac >"$folder/badge.svg"
((ran == 0)) || exit "$ran"
exit "$checked"
