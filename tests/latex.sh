#!/usr/bin/env bash
# Compiles the LaTeX tables of a store, one column and both columns wide, in two classes: no box may be overfull.
# Usage: latex.sh LOOPBENCH STORE
set -euo pipefail
loopbench=$(realpath "$1") store=$(realpath "$2")
command -v pdflatex >/dev/null || { echo 'skipped: latex.sh: pdflatex is not installed'; exit 0; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
declare -A kinds=([first score]='table' [all scores]="table --split sequence,times --plus-minus"
  [intervals]="table --intervals --caption Errors. --label tab:errors"
  [success]='table --success 0.1' [comparison]='compare')
failures=0
for kind in "${!kinds[@]}"; do
  for wide in "" --wide; do
    for class in article amsart; do
      read -ra words <<<"${kinds[$kind]}"
      "$loopbench" "${words[0]}" "$store" "${words[@]:1}" --format latex $wide -o table.tex
      cat >page.tex <<PAGE
\documentclass[twocolumn]{$class}
\usepackage[textwidth=174mm,columnsep=6mm,textheight=240mm]{geometry}
\usepackage{booktabs,graphicx}
\extrafloats{500}  % tables without text between them
\begin{document}
\input{table}
\end{document}
PAGE
      if ! pdflatex -interaction=nonstopmode -halt-on-error page.tex >log || grep -q '^Overfull' page.log; then
        failures=$((failures + 1))
        printf '%s %s %s: %s\n' "$kind" "$wide" "$class" "$(grep -m 1 -e '^!' -e '^Overfull' page.log)"
      fi
      grep -q 'aligned' table.tex || { failures=$((failures + 1)); echo "$kind: no alignment in the caption"; }
      ! grep -q '{-}{-}[a-z]' table.tex || { failures=$((failures + 1)); echo "$kind: an option of the command line"; }
    done
  done
done
echo "latex: ${#kinds[@]} kinds of tables in two widths and classes, $failures failures"
((failures == 0))
