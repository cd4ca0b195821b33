/// Columns of numbers for figures, rounded and compressed.
///
/// Bytes: the number of rows (a little-endian uint32), then each column:
///   low, high  its range (little-endian float32)
///   order      a byte, 1 or 2: what its words are predicted from
///   bits       a word for each row, from the highest bit of each byte; filled up with zeros
/// Words: 0 is NaN, w > 0 is low + (high - low) (w - 1) / steps. Predicted is the word before
/// (order 1), or of order 2 the word on the line through the two before, over the words t of the
/// first column: w1 + (w1 - w0) (t2 - t1) / (t1 - t0), rounded towards zero, within 0 to steps + 1;
/// over rows for the first column, for row 1 and if t1 is t0. Before row 0 are zeros. A difference
/// d from the prediction is the number n = 2 d, or -2 d - 1 if d < 0, in the adaptive code of Rice
/// (1971): n >> k ones and a zero, then the k low bits of n. k is the largest number such that
/// count << k does not exceed the sum, or 0; both begin at 1, then the sum grows by n and the count
/// by 1, and both are halved, rounded down, when the count is 8. 20 ones are followed by n in 24
/// bits.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace loopbench::harness {

/// Steps of a column: its values are rounded by at most 1/8192 of its range.
inline constexpr unsigned kDrawnSteps = 4096;
/// The same, for values that others are computed from: 1/131068.
inline constexpr unsigned kFineSteps = 65534;

/// Packs rows of `columns` values each; those that are not finite become NaN. The least and the
/// greatest value of a column stay exact. `steps`: at most kFineSteps. O(values).
std::string packed_columns(std::span<const float> rows, std::size_t columns, unsigned steps);

/// The rows that packed_columns() packed with the same `columns` and `steps`. Throws InputError if
/// the bytes are damaged. O(values).
std::vector<float> unpacked_columns(std::string_view bytes, std::size_t columns, unsigned steps);

}  // namespace loopbench::harness
