/// How long the blocks of a block bootstrap have to be.
#pragma once

#include <cstddef>
#include <span>

namespace loopbench {

/// The block length that estimates the spread of the mean best, from the sample's own
/// autocorrelation (Politis and White 2004, with the correction of Patton, Politis and White 2009;
/// the constant of circular blocks, which moving blocks share). Not below the largest lag whose
/// autocorrelation stands out of noise, nor 1; at most min(3 sqrt n, n / 3). Throws
/// std::invalid_argument when empty. O(n sqrt n).
std::size_t block_length(std::span<const double> values);

}  // namespace loopbench
