# shellcheck shell=bash
# Trajectories for transcripts: `. $DATA/../transcripts/paths.sh`. All print lines "t x y z qx qy qz qw".

# path ERROR [START [POSES]]: a winding way, with an error of that size [m]; other starts are other ways.
path() {
  awk -v error="$1" -v start="${2:-0}" -v poses="${3:-60}" 'BEGIN {
    for (i = 0; i < poses; ++i) {
      a = start + i / 10; e = error * sin(7 * a)
      printf "%.9f %.9f %.9f %.9f 0 0 %.9f %.9f\n",
        a, 3 * cos(a) + e, 3 * sin(a), (0.2 + 0.6 * start) * a + e, sin(a / 2), cos(a / 2)
    }
  }'
}

# systems FOLDER: ten runs of a good and a bad system on office and street, and truths/SEQUENCE.txt.
systems() {
  local sequence start run
  for sequence in office street; do
    [ $sequence = office ] && start=0 || start=1
    mkdir -p truths "$1/good/$sequence" "$1/bad/$sequence"
    path 0 $start >truths/$sequence.txt
    for run in 0 1 2 3 4 5 6 7 8 9; do
      path "0.01$((run / 2))$((run % 2 * 5))" $start >"$1/good/$sequence/$run.txt"
      path "0.03$run" $start >"$1/bad/$sequence/$run.txt"
    done
  done
}

# spiral BEGIN END STEP SPEED ERROR: poses on a spiral at that speed, with a sinusoidal error [m].
spiral() {
  awk -v begin="$1" -v end="$2" -v step="$3" -v speed="$4" -v error="$5" 'BEGIN {
    for (i = 0; begin + i * step <= end; ++i) {
      t = begin + i * step; radius = 20 + t / 10; a = speed * t / 20
      printf "%.6f %.9f %.9f %.9f 0 0 %.9f %.9f\n",
        t, radius * cos(a), radius * sin(a), error * sin(7 * t), sin(a / 2), cos(a / 2)
    }
  }'
}
