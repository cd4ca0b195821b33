#!/usr/bin/env bash
# Builds the Debian package, checks it with lintian, installs it into a bare Debian root and runs the default
# comparison there. Needs root; downloads Debian 12 from $DEBIAN_MIRROR (default: deb.debian.org).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
build=build/package

cmake --preset package >/dev/null
cmake --build $build --target loopbench loopbench_pages
rm -f $build/loopbench_*.deb
(cd $build && cpack -G DEB >/dev/null)
package=$(echo $build/loopbench_*.deb)
echo "package: $package, $(stat -c %s "$package") bytes"
lintian --allow-root --fail-on error "$package"

root=$(mktemp -d)
finish() {
  mountpoint -q "$root/proc" && umount "$root/proc"
  rm -rf "$root"
}
trap finish EXIT
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$build/debootstrap.log"
cp "$package" "$root/loopbench.deb"
cp /etc/resolv.conf "$root/etc/resolv.conf"
for settings in /etc/apt/apt.conf.d/*proxy*; do
  [[ -e $settings ]] && cp "$settings" "$root/etc/apt/apt.conf.d/"
done
mount -t proc proc "$root/proc" || mount --bind /proc "$root/proc"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
inside sh -c 'apt-get -qq update && apt-get -qq install -y --no-install-recommends /loopbench.deb' \
  >"$build/install.log" 2>&1 || { tail -20 "$build/install.log"; exit 1; }

inside loopbench --version
inside sh -c 'test -s /usr/share/loopbench/configs/quickstart.yaml'
# minbase excludes documents from packages only if told so; manual pages and completions are there.
inside sh -c 'zcat /usr/share/man/man1/loopbench-run.1.gz | grep -q "^.SH NAME"'
inside bash -c '. /usr/share/bash-completion/completions/loopbench && complete -p loopbench'
inside sh -c 'cd /root && loopbench run quickstart' | tail -12
inside sh -c 'cd /root && loopbench report results/quickstart -o report.html && test -s report.html'
echo "package: runs in a bare Debian"
