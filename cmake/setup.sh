# Sourced by run.sh and test.sh: installs what is missing, says so, and is silent otherwise.
# Needs Debian 12 (or a relative with the same package names). Who sources it may name more_packages.

packages=(
  g++ cmake ninja-build ccache
  libeigen3-dev libfmt-dev libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libsqlite3-dev libre2-dev libceres-dev
  libopencv-features2d-dev libopencv-calib3d-dev libopencv-imgcodecs-dev libstb-dev
  libgtest-dev libgmock-dev libbenchmark-dev gnuplot-nox
  "${more_packages[@]}"
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done

if ((${#missing[@]})); then
  if ! command -v apt-get >/dev/null; then
    echo "loopbench: please install, by the names of Debian 12: ${missing[*]}" >&2
    exit 2
  fi
  as_root=()
  ((EUID == 0)) || as_root=(sudo)
  echo "loopbench: installing ${missing[*]}" >&2
  "${as_root[@]}" apt-get -qq update >&2
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" \
    apt-get -qq install -y --no-install-recommends "${missing[@]}" >&2
fi
unset packages missing package status as_root
