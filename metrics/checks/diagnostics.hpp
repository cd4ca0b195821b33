/// Can the numbers be trusted at all? What was matched, lost, doubled, or never turned.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct DiagnosticsOptions {
  double standing = 0.05;
  double window = 1.0;
  double loss = 2.0;
};

template <class Visit>
void fields(DiagnosticsOptions& o, Visit visit) {
  visit("standing", o.standing, "slower than this is standing still [m/s]", Between{0.0});
  visit("window", o.window, "time over which speed is taken [s]", Between{0.0});
  visit("loss", o.loss, "longest pause of the estimate that is no tracking loss [s]", Above{0.0});
}

/// Values behind the scores of `diagnostics`.
struct Diagnostics {
  std::size_t matched = 0;
  std::size_t possible = 0;
  double largest_gap = 0.0;  ///< between neighbouring pairs [s]
  /// Pairs that use a pose again (association evo), and pairs that step back in time against the
  /// one before (association tum, around bursts). Doubled and unsorted stamps inside one file never
  /// come this far: readers refuse them, or keep one when told to.
  std::size_t repeated = 0;
  std::size_t crossing = 0;
  double off_unit = 0.0;  ///< largest | |q| - 1 |; readers refuse above their limit and normalise
  int rank = 3;           ///< of the alignment, see Alignment
  double condition = 1.0;
  double standing = 0.0;  ///< share of pairs at which the reference stands still, 0..1
  bool position_only_reference = false;  ///< then rotation is not judged
  bool position_only_estimate = false;
  /// Pauses of the estimate longer than `loss` during which the reference moved.
  std::size_t losses = 0;
  double lost = 0.0;          ///< all of them together [s]
  double longest_loss = 0.0;  ///< [s]
};

/// O(n + m). Losses are looked for where the context has the whole estimate and reference.
Diagnostics diagnose(const Evaluation& evaluation, const DiagnosticsOptions& options);

/// Each value of Diagnostics as a single number; shares in %, flags as 0 or 1.
std::vector<Score> diagnostics(const Evaluation& evaluation, const DiagnosticsOptions& options);

}  // namespace loopbench
