#!/usr/bin/env bash
# test_package.sh [FOLDER]: installs what release.sh wrote into FOLDER (default: dist) into bare roots of Debian 12 and 13, each
# file by one line, and runs the default comparison: the verdict has to be that of README. The package has to satisfy lintian.
# Needs root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=$(realpath "${1:-dist}")
source cmake/setup.sh
source cmake/package/roots.sh
install_missing "${root_packages[@]}"
verdict=$(grep -m 1 '^### ate, dense: ' README.md)
(cd "$folder" && sha256sum --quiet -c SHA256SUMS)

# passed WHAT COMMAND: COMMAND, which runs the default comparison, prints the verdict.
passed() {
  inside "{ $2; } >output"
  grep -qFx "$verdict" "$root/root/output" ||
    { echo "package: $1: expected '$verdict', found:" && head -20 "$root/root/output"; exit 1; } >&2
  echo "package: $1: runs, with the verdict of README"
}

for system in "${!suites[@]}"; do
  make_root "${suites[$system]}"
  package=$(echo "$folder"/loopbench_*_"$system"_*.deb)
  cp "$folder"/loopbench[-_]* "$root/root"

  inside "apt-get -qq install -y --no-install-recommends python3-pip python3-numpy"
  inside "pip install --break-system-packages --no-index --only-binary :all: --find-links . loopbench"
  inside "python3 -c 'from loopbench import _core'"
  passed "wheel on $system" "loopbench run quickstart"
  inside "pip uninstall -y --break-system-packages loopbench && rm -rf results && ! command -v loopbench"

  inside "apt-get -qq install -y --no-install-recommends ./${package##*/}"
  passed "${package##*/}" "loopbench run quickstart"
  inside "loopbench report results/quickstart -o report.html && test -s report.html"
  inside "zcat /usr/share/man/man1/loopbench-run.1.gz | grep '^.SH NAME'"
  inside ". /usr/share/bash-completion/completions/loopbench && complete -p loopbench"
  inside "cd /usr/share && test -s loopbench/configs/quickstart.yaml -a -s loopbench/configs/schema.json"
  inside "grep 'Mike Bostock' /usr/share/doc/loopbench/copyright"
  inside "apt-get -qq install -y --no-install-recommends lintian"
  inside "lintian --allow-root --fail-on error,warning ./${package##*/}"

  passed "sources on $system" "tar xzf loopbench-*.tar.gz && cd loopbench-*/ && ./run.sh"
done
