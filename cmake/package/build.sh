#!/usr/bin/env bash
# build.sh FOLDER [wheel]: installs what is missing, builds this checkout, and writes its Debian package for the system that
# this runs on into FOLDER: loopbench_1.0.0_debian12_amd64.deb. With `wheel`, also a wheel for the Python of this system
# that contains the libraries it needs.
set -euo pipefail
folder=$(realpath -m "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source cmake/setup.sh
targets=(loopbench loopbench_pages)
install_missing "${packages[@]}" "${image_packages[@]}" "${package_packages[@]}"
if [[ ${2-} == wheel ]]; then
  install_missing "${python_packages[@]}" "${wheel_packages[@]}"
  targets+=(loopbench_python)
fi

mkdir -p "$folder"
quietly cmake --preset package
cmake --build build/package --target "${targets[@]}"
rm -f build/package/loopbench_*.deb
(cd build/package && quietly cpack -G DEB)
cp build/package/loopbench_*.deb "$folder"
if [[ ${2-} == wheel ]]; then
  pip wheel -q --no-index --no-deps -w "$folder" . \
    --config-settings build-dir=build/package --config-settings libraries=inside
fi
