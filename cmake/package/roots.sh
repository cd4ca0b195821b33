# shellcheck shell=bash disable=SC2034  # the list is used by the scripts that source this
# Sourced by release.sh and test_package.sh, which need root: bare roots of Debian, downloaded from $DEBIAN_MIRROR.
declare -A suites=([debian12]=bookworm [debian13]=trixie)
root=

remove_root() {
  [[ -n $root ]] || return 0
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf "$root"
  root=
}
trap remove_root EXIT

# make_root SUITE: a new root in $root, instead of the one before.
make_root() {
  remove_root
  root=$(mktemp -d)
  quietly debootstrap --variant=minbase "$1" "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  local settings
  for settings in /etc/apt/apt.conf.d/*proxy*; do
    [[ ! -e $settings ]] || cp "$settings" "$root/etc/apt/apt.conf.d/"
  done
  mount -t proc proc "$root/proc" || mount --bind /proc "$root/proc"
  inside "apt-get -qq update"
}

# inside COMMANDS: runs them by bash in the root, in its folder /root; prints their output only if they fail.
inside() {
  quietly chroot "$root" env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive bash -euc "cd; $1"
}
