/// Which rows of a long curve are enough to draw it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace loopbench::harness {

/// At most `most` evenly spaced indices of 0..count-1, including both ends.
inline std::vector<std::size_t> subsampled_indices(std::size_t count, std::size_t most) {
  const std::size_t kept = std::min(count, most);
  std::vector<std::size_t> out(kept);
  for (std::size_t i = 0; i < kept; ++i) out[i] = kept == 1 ? 0 : i * (count - 1) / (kept - 1);
  return out;
}

/// Sorts rows and removes those that are listed twice.
void sort_unique(std::vector<std::size_t>& rows);

/// Columns of equal length that are drawn as one line: a map, or values over time. Rows in which a
/// column is NaN interrupt it.
struct DrawnLine {
  std::vector<std::span<const double>> axes;
  double deviation = 0.0;  ///< largest distance of a row from the drawn line
};

/// Adds rows to `kept`, which is sorted and begins with the first and ends with the last row, until
/// every row is within the deviation of each line (Douglas and Peucker 1973); the result is sorted.
/// O(rows log(rows)) for each line: parts that fall apart row by row are halved.
void keep_deviating(std::vector<std::size_t>& kept, const std::vector<DrawnLine>& lines);

}  // namespace loopbench::harness
