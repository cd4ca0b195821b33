#!/usr/bin/env bash
# Checks outputs that the pages print against the program. A comment before a code block or a table names the
# command: <!-- output of: ./run.sh eval a.txt b.txt -->. Every line of the block must be among the printed lines, in
# that order; "..." stands for further lines. Spaces and times are ignored. <!-- part of: FILE --> names a file, and
# <!-- numbers of: FILES or COMMAND --> what contains all numbers with decimals of the block.
# Usage: documented_outputs.sh LOOPBENCH ROOT [QUICKSTART], a folder with the results of quickstart; without it, its
# outputs are skipped.
set -euo pipefail
loopbench=$(realpath "$1") root=$(realpath "$2") quickstart=${3:+$(realpath "$3")}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$root/configs" "$work/configs"
export LOOPBENCH_NAME=./run.sh
failures=0 checked=0 skipped=0

# Without spaces, the dashes of rules, and times: "37 ms" and the last column of tables named "cpu [ms]".
plain() {
  awk '{ gsub(/[ \t]+/, " "); sub(/^ /, ""); sub(/ $/, ""); gsub(/-+:?/, "-"); gsub(/[0-9.]+ ms/, "_ ms")
    if ($0 !~ /^\|/) is_table = 0
    else if (!is_table) { is_table = 1; has_time = $0 ~ /\| cpu \[ms\] \|$/ }
    if (is_table && has_time) sub(/[^|]*\|$/, "")
    print }'
}

# Prints the first line of the block (file 1) that is not in the output (file 2) after the lines before it.
missing_line() {
  awk 'NR == FNR { line[++n] = $0; next }
    wanted < n && $0 == line[wanted + 1] { ++wanted }
    END { if (wanted < n) print line[wanted + 1] }' "$1" "$2"
}

# The first number with decimals of the block (file 1) that is not in file 2.
missing_number() { grep -oE '[0-9]+\.[0-9]+' "$1" | grep -vxFf <(grep -oE '[0-9]+\.[0-9]+' "$2") | head -n 1 || true; }

check() {
  local where=$1 kind=$2 text=$3 block=$4
  if [[ $text != './run.sh '* ]]; then
    # shellcheck disable=SC2086  # a pattern
    (cd "$root" && cat $text) >"$work/.said"
  else
    read -ra words <<<"${text#./run.sh }"
    case $text in
      *quickstart*)
        [[ -n $quickstart ]] || { skipped=$((skipped + 1)); return; }
        words=("${words[@]/results\/quickstart/$quickstart}")
        [[ ${words[0]} != run ]] || words+=(--out "$quickstart") ;;
    esac
    (cd "$work" && "$loopbench" "${words[@]}") >"$work/.said" 2>&1 || true
  fi
  plain <"$work/.said" >"$work/.plain"
  grep -v '^ *\.\.\.$' <<<"$block" | sed '/^ *$/d' | plain >"$work/.block"
  checked=$((checked + 1))
  local line
  if [[ $kind == numbers ]]; then
    line=$(missing_number "$work/.block" "$work/.said")
  else
    line=$(missing_line "$work/.block" "$work/.plain")
  fi
  [[ -z $line ]] || { printf '%s: %s: does not contain\n  %s\n' "$where" "$text" "$line"; failures=$((failures + 1)); }
}

while IFS= read -r page; do
  kind='' text='' block='' number=0 at=0 is_fenced=false
  while IFS= read -r line || [[ -n $line ]]; do
    number=$((number + 1))
    if [[ $line =~ ^'<!-- '(output|part|numbers)' of: '(.*)' -->'$ ]]; then
      kind=${BASH_REMATCH[1]} text=${BASH_REMATCH[2]} block='' at=$number is_fenced=false
    elif [[ -z $kind ]]; then
      continue
    elif [[ $line == '```'* ]] && ! $is_fenced; then
      is_fenced=true
    elif [[ $line == '```' ]] || { ! $is_fenced && [[ -z $line && -n $block ]]; }; then
      check "${page#"$root"/}:$at" "$kind" "$text" "$block"
      kind=''
    elif $is_fenced || [[ -n $line ]]; then
      block+=$line$'\n'
    fi
  done <"$page"
  [[ -z $kind ]] || { printf '%s:%s: the block has no end\n' "$page" "$at"; failures=$((failures + 1)); }
done < <(find "$root" -name '*.md' -not -path '*/build/*' -not -name CHANGELOG.md)

printf '%d outputs checked, %d wrong, %d skipped\n' "$checked" "$failures" "$skipped"
((failures == 0 && checked >= 4))
