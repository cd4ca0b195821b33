/// Intervals by resampling: seeded, so the same on every machine and run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace loopbench {

/// A statistic of the observations with these indices, which may repeat.
using Resampled = std::function<double(std::span<const std::size_t>)>;

struct BootstrapOptions {
  std::size_t resamples = 10000;
  double level = 0.95;     ///< of confidence, within (0, 1)
  std::uint64_t seed = 1;  ///< of std::mt19937_64
};

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The statistic on each resample, in the order drawn: of blocks of `block` neighbours, cut off at
/// n. Blocks of one are independent draws. Throws std::invalid_argument on n = 0, block = 0 and
/// options out of range. O(resamples * n).
std::vector<double> block_values(std::size_t n,
                                 std::size_t block,
                                 const Resampled& statistic,
                                 const BootstrapOptions& options = {});

/// Quantiles of the statistic over resamples of n independent observations (Efron 1979). Throws
/// std::invalid_argument on n = 0 and options out of range. O(resamples * n).
Interval percentile_interval(std::size_t n,
                             const Resampled& statistic,
                             const BootstrapOptions& options = {});

/// Bias-corrected and accelerated (Efron 1987; Efron and Tibshirani 1993, chapter 14): quantiles
/// shifted for median bias and for skewness, the latter from the jackknife. The percentile interval
/// where the statistic does not vary. Throws as above, and on n = 1.
Interval bca_interval(std::size_t n,
                      const Resampled& statistic,
                      const BootstrapOptions& options = {});

/// The percentile interval over moving blocks (Kuensch 1989) of `block` neighbours, for n
/// observations that follow each other and are correlated, as errors along a trajectory are.
/// `block` >= n gives a degenerate interval. Throws as above, and on block = 0.
Interval block_interval(std::size_t n,
                        std::size_t block,
                        const Resampled& statistic,
                        const BootstrapOptions& options = {});

}  // namespace loopbench
