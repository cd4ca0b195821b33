#!/usr/bin/env bash
# Compares the sizes of the project with their limits in budgets.txt: lines of .cpp and .hpp files below a folder, of all
# folders but tests (product), and words of the pages (words).
# Usage: budgets.sh ROOT [LIMITS]   (default ROOT/tests/budgets.txt)
set -euo pipefail
cd "$1"
limits=${2:-tests/budgets.txt}
failures=0 checked=0
# Files below folders, without those of builds and the tables of sweeps.
below() {
  local pattern=$1
  shift
  find "$@" -type d \( -name build -o -name .git \) -prune -o -type f -regex "$pattern" ! -name table.md -print0
}
lines() { below '.*\.[ch]pp' "$@" | xargs -0 cat | wc -l; }

while read -r name limit; do
  [[ $name && $name != \#* ]] || continue
  case $name in
    product) size=$(($(lines .) - $(lines tests))) ;;
    words) size=$(below '.*\.md' . | xargs -0 cat | wc -w) ;;
    *) [[ -d $name ]] || { echo "$limits: no folder is named '$name'"; exit 1; }
      size=$(lines "$name") ;;
  esac
  checked=$((checked + 1))
  printf '%-9s %6d of %6d\n' "$name" "$size" "$limit"
  ((size <= limit)) || { failures=$((failures + 1)); echo "  above its limit: remove as much elsewhere in $name"; }
done <"$limits"

printf '%d sizes checked, %d above their limits\n' "$checked" "$failures"
((failures == 0 && checked > 0))
