#!/usr/bin/env bash
# Builds a colcon workspace of this package and of tests/plugin/embedded, which depends on it, and runs both.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
workspace=$(mktemp -d)
trap 'rm -rf "$workspace"' EXIT
mkdir -p "$workspace/src/embedded"
ln -s "$root" "$workspace/src/loopbench"
cp "$root"/tests/plugin/embedded/* "$workspace/src/embedded"
echo 'install(TARGETS embedded)' >>"$workspace/src/embedded/CMakeLists.txt"
cat >"$workspace/src/embedded/package.xml" <<'END'
<package format="3">
  <name>embedded</name>
  <version>0.0.0</version>
  <description>Uses loopbench</description>
  <maintainer email="nobody@example.org">Nobody</maintainer>
  <license>Apache-2.0</license>
  <depend>loopbench</depend>
  <export><build_type>cmake</build_type></export>
</package>
END
cd "$workspace"
colcon build --cmake-args -GNinja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_RELEASE=-O0 \
  -DLOOPBENCH_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=40
set +u
# shellcheck source=/dev/null
source install/setup.bash
set -u
version=$(sed -n 's|.*<version>\(.*\)</version>.*|\1|p' "$root/package.xml")
[[ $(loopbench --version) == "loopbench $version"* ]]
example=$root/configs/example
install/embedded/bin/embedded "$example/reference.txt" "$example/open.txt" "$example/loops.txt"
