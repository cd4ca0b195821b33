#!/usr/bin/env bash
# Tests datasets/fetch.sh with files in place of servers.
# Usage: fetch_test.sh ROOT
set -euo pipefail
fetch=$(realpath "$1/datasets/fetch.sh")
command -v curl >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0

# check NAME COMMAND...: fails unless the command succeeds.
check() {
  local name=$1
  shift
  "$@" || { echo "failed: $name: $*"; failures=$((failures + 1)); }
}
# fails_with TEXT ARGS...: fails unless fetch.sh exits with 1 and prints the text.
fails_with() {
  local text=$1 code=0
  shift
  "$fetch" "$@" >log 2>&1 || code=$?
  [[ $code == 1 && $(<log) == *"$text"* ]] || { echo "failed: exit code $code, expected 1 and '$text': $(<log)"; failures=$((failures + 1)); }
}
quiet() { "$fetch" "$@" >log 2>&1 || { cat log; return 1; }; }
hash_of() { sha256sum "$1" | cut -d ' ' -f 1; }

# Each row of the script's own table is complete, and copies in the data folder have the stated hashes.
sed -n '/<<END$/,/^END$/p' "$fetch" | sed '1d;$d' >rows
row='^[a-z0-9_]+ [^/ ][^ ]* (file|tgz|zip) [0-9a-f]{64} (https:|\$)[^ ]+ [0-9.]+ [MG]B, .'
check 'rows are complete' test -z "$(grep -vE "$row" rows)"
check 'names are distinct' test -z "$(cut -d ' ' -f 1 rows | sort | uniq -d)"
check 'the list has all rows' test "$("$fetch" --list | wc -l)" -eq "$(wc -l <rows)"
if [[ -n ${LOOPBENCH_DATA:-} ]]; then
  while read -r name place kind _; do
    [[ $kind != file || ! -e $LOOPBENCH_DATA/$place ]] || check "hash of $place" quiet "$name" "$LOOPBENCH_DATA"
  done <rows
fi
check 'help has an example' grep -q '^Example: datasets/fetch.sh ' <("$fetch" --help)

seq 1000 >numbers
mkdir -p room
cp numbers room
tar -czf one.tgz room
tar -czf two.tgz room numbers
export LOOPBENCH_FETCH_TABLE=$work/table
cat >table <<END
plain below/numbers.txt file $(hash_of numbers) file://$work/numbers 4 kB, none
changed below/changed.txt file $(hash_of one.tgz) file://$work/numbers 4 kB, none
absent below/absent.txt file $(hash_of numbers) file://$work/absent 4 kB, none
folder below/room_1 tgz $(hash_of one.tgz) file://$work/one.tgz 4 kB, none
several below/room_2 tgz $(hash_of two.tgz) file://$work/two.tgz 4 kB, none
END

check 'a file' quiet plain out
check 'its content' cmp numbers out/below/numbers.txt
check 'a file that is already present' grep -q 'is already present' <("$fetch" plain out)
echo damaged >out/below/numbers.txt
fails_with 'remove it to download it again' plain out
check 'it stays' grep -q damaged out/below/numbers.txt
rm out/below/numbers.txt
head -c 100 numbers >out/below/numbers.txt.part
check 'the rest of a file' quiet plain out
check 'the whole content' cmp numbers out/below/numbers.txt
rm out/below/numbers.txt
cp numbers out/below/numbers.txt.part
check 'a complete part' quiet plain out
LOOPBENCH_DATA=other check 'the folder of LOOPBENCH_DATA' quiet plain
check 'is used' test -e other/below/numbers.txt

fails_with "rejected: its SHA-256 is $(hash_of numbers), expected $(hash_of one.tgz)" changed out
fails_with 'run the command again to continue' absent out
fails_with "no dataset is named 'unknown', expected one of: plain changed" unknown out
check 'a folder' quiet folder out
check 'is unpacked' cmp numbers out/below/room_1/numbers
check 'several files' quiet several out
check 'are in one folder' cmp out/below/room_2/numbers out/below/room_2/room/numbers
check 'nothing else is left' test "$(find out -type f | wc -l)" -eq 4
if command -v unzip >/dev/null; then
  python3 -m zipfile -c one.zip room
  echo "zipped below/room_3 zip $(hash_of one.zip) file://$work/one.zip 4 kB, none" >>table
  check 'a zip archive' quiet zipped out
  check 'its folder is unpacked' cmp numbers out/below/room_3/numbers
fi

echo "failures: $failures"
((failures == 0))
