/// Pairs of rows for association `index`, if rows were dropped or cut: rows keep their numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "harness/commands/eval/evaluated_file.hpp"

namespace loopbench::harness {

/// The numbers of the rows of the poses, from 0 on.
inline std::vector<std::size_t> row_numbers(const EvaluatedFile& file) {
  if (!file.rows.empty()) return file.rows;
  std::vector<std::size_t> out(file.poses.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

/// The numbers of the rows that remain of `count` rows without `dropped`, both ascending.
inline std::vector<std::size_t> rows_without(std::size_t count,
                                             const std::vector<std::size_t>& dropped) {
  std::vector<std::size_t> all(count), out;
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::ranges::set_difference(all, dropped, std::back_inserter(out));
  return out;
}

/// The poses of two files in rows that both have. Copies both. O(rows).
inline std::pair<EvaluatedFile, EvaluatedFile> with_common_rows(const EvaluatedFile& a,
                                                                const EvaluatedFile& b) {
  const std::vector<std::size_t> of_a = row_numbers(a), of_b = row_numbers(b);
  std::vector<std::size_t> in_a, in_b;
  for (std::size_t i = 0, j = 0; i < of_a.size() && j < of_b.size();) {
    if (of_a[i] == of_b[j]) {
      in_a.push_back(i++);
      in_b.push_back(j++);
    } else if (of_a[i] < of_b[j]) {
      ++i;
    } else {
      ++j;
    }
  }
  std::pair out{a, b};
  keep_poses(out.first, in_a);
  keep_poses(out.second, in_b);
  return out;
}

/// How many poses of `estimate` are in the range of rows of the reference.
inline std::size_t rows_in_range(const EvaluatedFile& reference, const EvaluatedFile& estimate) {
  const std::vector<std::size_t> range = row_numbers(reference), rows = row_numbers(estimate);
  return static_cast<std::size_t>(std::ranges::count_if(
      rows, [&](std::size_t row) { return range.front() <= row && row <= range.back(); }));
}

}  // namespace loopbench::harness
