#!/usr/bin/env bash
# Runs the commands of the READMEs as a reader copies them, each line of a block that calls loopbench, in a folder with
# files of the names that the pages use. A command must exit with 0, or with 1 where its comment mentions "exit 1".
# Left out are commands that need real data (--data DIR), and quickstart without its results.
# Usage: documented_runs.sh LOOPBENCH ROOT [QUICKSTART], a folder with the results of quickstart.
set -euo pipefail
loopbench=$(realpath "$1") root=$(realpath "$2") quickstart=${3:+$(realpath "$3")}
pages=(README.md {datasets,methods,metrics}/README.md metrics/files.md harness/{README,figures}.md
  methods/bring_a_method.md)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
example=$root/configs/example
cd "$work"

mkdir -p bin results truths systems/{ours,theirs}/room
for name in run.sh bin/loopbench; do
  printf '#!/bin/sh\nexec "%s" "$@"\n' "$loopbench" >$name
  chmod +x $name
done
printf '#!/bin/sh\necho 1\n' >bin/sbatch  # the scripts themselves run in tests/slurm
chmod +x bin/sbatch
printf '#SBATCH --time=1:00:00\n' >slurm.sh
export PATH=$work/bin:$PATH LOOPBENCH_NAME=./run.sh
ln -s "$root/configs" configs
ln -s "$root/results/reference" results/reference
[[ -z $quickstart ]] || cp -r "$quickstart" results/quickstart
cp "$example"/{reference,open,loops}.txt .
for name in gt marker truths/room; do cp reference.txt $name.txt; done
for name in estimate good camera est robot_{a,b} run_{1,2,3} monday tuesday systems/ours/room/{1,2}; do
  cp open.txt "$name.txt"
done
cp "$example/other.txt" systems/theirs/room/1.txt
# An antenna in degrees, and every tenth position with a filler quaternion.
awk 'BEGIN { print "time,latitude,longitude,height" }
  !/^#/ { printf "%s,%.12f,%.12f,%s\n", $1, 47 + $3 / 111111, 8 + $2 / 75800, $4 }' reference.txt >gnss.csv
awk '!/^#/ && n++ % 10 == 0 { print $1, $2, $3, $4, 0, 0, 0, 1 }' reference.txt >points.txt
awk '!/^#/ { printf "%s", $0; for (i = 0; i < 36; ++i) printf " %s", i % 7 ? 0 : 0.01; print "" }' estimate.txt >wide.txt
echo 'not a trajectory' >broken.txt
mkdir runs
cp gt.txt est.txt runs
gzip -k est.txt
cp "$root/tests/data/fuzz/bag/valid.bag" run.bag
cp "$root/tests/data/fuzz/bag/valid.mcap" run.mcap
# Fast methods in place of those of the example: this checks commands, not methods.
sed 's/^methods: .*/methods: [raw, uniform, dual]/' "$example/mine.yaml" | tee mine.yaml >sweep.yaml
{
  loopbench traj convert bag:run.mcap#/pose --to tum -o bag.txt
  loopbench run mine.yaml --out results/a --only raw
  loopbench run mine.yaml --out results/b --only dual
} >log 2>&1 || { cat log; exit 1; }

ran=0 skipped=0 failures=0
while IFS= read -r hit; do
  where=${hit%%:\#*} line=${hit#*:\#}
  case $line in
    *'--data DIR'* | *' --memory 16GiB' | './run.sh   '*) skipped=$((skipped + 1)); continue ;;
    *results/quickstart*) [[ -n $quickstart ]] || { skipped=$((skipped + 1)); continue; } ;;
  esac
  # The bag has another topic and three poses on a line.
  line=${line/'gt.txt bag:run.mcap#/odom'/'bag.txt bag:run.mcap#/pose --align none'}
  code=0
  timeout 120 bash -o pipefail -c "$line" >log 2>&1 </dev/null || code=$?
  ran=$((ran + 1))
  ((code == 0)) || { ((code == 1)) && [[ $line == *'exit 1'* ]]; } ||
    { printf '%s: exit code %d: %s\n' "$where" "$code" "$line"; cat log; failures=$((failures + 1)); }
done < <(cd "$root" && grep -nE '^ *(zcat [^|]*\| )?(\./run\.sh|loopbench) ' "${pages[@]}" | sed -E 's/^([^:]*:[0-9]+): */\1:#/')

printf '%d commands run, %d failed, %d skipped\n' "$ran" "$failures" "$skipped"
((failures == 0 && ran >= 25))
