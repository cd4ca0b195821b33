#!/usr/bin/env bash
# release.sh [FOLDER]: writes the files of a release of the last commit into FOLDER (default: dist): for Debian 12 and 13 a
# package and a wheel each, the sources, what changed, and checksums. Publishes nothing. Needs root; builds in bare roots.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=$(realpath -m "${1:-dist}")
source cmake/setup.sh
source cmake/package/roots.sh
install_missing "${root_packages[@]}"

fail() { echo "release: $1" >&2; exit 2; }
version=$(sed -n 's/^project(loopbench VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
tag=$(git tag --points-at HEAD 'v*')
[[ -z $tag || $tag == "v$version" ]] || fail "the tag is $tag, but the version in CMakeLists.txt is $version"
[[ -z $(git status --porcelain --untracked-files=no) ]] || fail "commit your changes first: git status"

mkdir -p "$folder"
rm -f "$folder"/loopbench[-_]* "$folder"/{CHANGES.md,SHA256SUMS}
awk -v title="## $version " 'index($0, "## ") == 1 { is_in = index($0, title) == 1; next } is_in' CHANGELOG.md \
  >"$folder/CHANGES.md"
[[ -s $folder/CHANGES.md ]] || fail "CHANGELOG.md has no section '## $version (DATE)'"
git archive --prefix="loopbench-$version/" -o "$folder/loopbench-$version.tar.gz" HEAD
for system in "${!suites[@]}"; do
  echo "release: building for $system"
  make_root "${suites[$system]}"
  inside "apt-get -qq install -y --no-install-recommends git"  # the program states the commit that it is built from
  git clone -q . "$root/source"
  inside "/source/cmake/package/build.sh /dist wheel"
  cp "$root"/dist/* "$folder"
done
(cd "$folder" && sha256sum -- loopbench[-_]* >SHA256SUMS && cat SHA256SUMS)
