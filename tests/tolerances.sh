#!/usr/bin/env bash
# Prints how much of its limit every numerical tolerance of the tests uses, at most over builds and instruction sets:
# clang and GCC, Eigen without vectors, with AVX2 and, where the processor has it, AVX-512, and the functions of the C
# library for older processors. Exit code 1 if one uses more than a fifth of its limit. Takes about as long as five builds.
# Usage: tests/tolerances.sh [FOLDER]   (default build/tolerances)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(realpath -m "${1:-build/tolerances}")
programs=(core_test datasets_test methods_test metrics_test)
old_processor=glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-AVX,-BMI1,-BMI2

variants=("clang-sse2|clang++|" "gcc-sse2|g++|" "clang-scalar|clang++|-DEIGEN_DONT_VECTORIZE" "clang-avx2|clang++|-march=x86-64-v3")
! grep -q avx512f /proc/cpuinfo || variants+=("gcc-avx512|g++|-march=x86-64-v4")
mkdir -p "$folder"
rm -f "$folder"/*.txt
for variant in "${variants[@]}"; do
  IFS='|' read -r name compiler flags <<<"$variant"
  preset=release
  [[ $compiler != g++ ]] || preset=gcc
  cmake --preset "$preset" -B "$folder/$name" -DLOOPBENCH_BUILD_TESTS=ON "-DCMAKE_CXX_FLAGS=$flags -w" >/dev/null
  cmake --build "$folder/$name" --target "${programs[@]}"
  for program in "${programs[@]}"; do
    LOOPBENCH_TOLERANCES=$folder/$name.txt "$folder/$name/tests/$program" --gtest_brief=1 ||
      echo "$name: $program failed"
    LOOPBENCH_TOLERANCES=$folder/$name-old.txt GLIBC_TUNABLES=$old_processor "$folder/$name/tests/$program" \
      --gtest_brief=1 || echo "$name: $program failed with the functions for older processors"
  done
done

# Limits above 1e-5 compare quantities of the world (noise, resampling), not rounding.
awk -v root="$PWD/" '
  $2 > 1e-5 { next }
  { sub(root, "", $3); variant = FILENAME; sub(/.*\//, "", variant); sub(/\.txt$/, "", variant)
    if (!($3 in worst) || $1 + 0 > worst[$3]) { worst[$3] = $1 + 0; line[$3] = $2 " " $3 " " $4 " " variant } }
  END { for (place in worst) print worst[place], line[place] }' "$folder"/*.txt | sort -gr >"$folder/worst.list"
awk 'BEGIN { print "share of limit, limit, place, test, build" } NR <= 40 || $1 > 0.2' "$folder/worst.list"
awk '$1 > 0.2 { ++near } END { printf "%d tolerances, %d use more than a fifth of their limit\n", NR, near; exit near > 0 }' \
  "$folder/worst.list"
