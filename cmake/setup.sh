# shellcheck shell=bash disable=SC2034  # the lists are used by the scripts that source this
# Sourced by run.sh and test.sh: install_missing PACKAGE... installs missing packages and prints their names.
# Debian 12 and 13 have these names; those of Ubuntu 24.04 were not checked.

packages=(
  clang cmake ninja-build
  libeigen3-dev libfmt-dev libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libsqlite3-dev libre2-dev libxxhash-dev
  libceres-dev
  zlib1g-dev libbz2-dev libzstd-dev liblz4-dev liblzma-dev  # compressed files and bags
  libgeographiclib-dev  # latitudes and longitudes
)
sandbox_packages=(bubblewrap)  # hides files from external programs; the default comparison has none

# OpenCV's development packages depend on some 280 others, so run.sh installs them when first needed.
image_packages=(libstb-dev libopencv-features2d-dev libopencv-calib3d-dev)
plot_packages=(python3-matplotlib)
latex_packages=(texlive-latex-base texlive-latex-recommended texlive-pictures)  # tables and figures; .ci/run installs it
sanitizer_packages=(libclang-rt-dev llvm)  # llvm: names of functions in reports
lint_packages=(clang-format clang-tidy shellcheck)
slurm_packages=(slurm-wlm munge)  # a real cluster for tests/slurm
colcon_packages=(colcon)
package_packages=(g++ dpkg-dev file help2man)
wheel_packages=(python3-pip patchelf)
root_packages=(debootstrap debian-archive-keyring)  # bare roots of Debian
# The compiled module of the Python package is optional: without these it is not built.
python_packages=(python3-dev python3-numpy pybind11-dev)
benchmark_packages=(libbenchmark-dev)
test_packages=(ccache libopencv-imgcodecs-dev libgtest-dev libgmock-dev curl
  python3-scipy python3-yaml python3-matplotlib python3-jsonschema python3-pip)
# Programs that configs/external compares with; no script installs them.
external_packages=(mrpt-apps)

installed=()  # by install_missing

# Runs a command; prints its output, to standard error, only if it fails.
quietly() {
  local log code=0
  log=$("$@" 2>&1) || code=$?
  ((code == 0)) || printf '%s\n' "$log" >&2
  return "$code"
}

install_missing() {
  local package status missing=()
  for package in "$@"; do
    status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
    [[ $status == ii* ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  if ! command -v apt-get >/dev/null; then
    echo "loopbench: please install these packages (names of Debian and Ubuntu): ${missing[*]}" >&2
    exit 2
  fi
  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      { echo "loopbench: please run this as root: apt-get install ${missing[*]}" >&2; exit 2; }
    as_root=(sudo)
  fi
  echo "loopbench: installing ${missing[*]}" >&2
  quietly "${as_root[@]}" apt-get -qq update
  quietly "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -qq install -y --no-install-recommends "${missing[@]}"
  installed+=("${missing[@]}")
}
