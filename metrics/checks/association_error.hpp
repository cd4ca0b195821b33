/// Position error caused by pairing poses of different times, independent of the estimate.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

struct AssociationError {
  double largest_difference = 0.0;  ///< largest time difference within a pair [s]
  double metres = 0.0;              ///< root mean square of |dt| times the reference's speed [m]
};

/// Index of the first pose at or after `stamp`, or of the last pose. Ascending stamps, as paired
/// poses have them, take a step or two from the index found before.
inline std::size_t index_at(const Trajectory& reference, double stamp, std::size_t before) {
  const std::size_t last = reference.size() - 1;
  std::size_t at = before;
  for (int steps = 0; steps < 8; ++steps, ++at) {
    const bool is_after_previous = at == 0 || reference[at - 1].stamp < stamp;
    if (!is_after_previous) break;
    if (at == last || reference[at].stamp >= stamp) return at;
  }
  const auto found = std::ranges::lower_bound(reference, stamp, {}, &StampedPose::stamp);
  return std::min(static_cast<std::size_t>(found - reference.begin()), last);
}

/// Speed [m/s] from the pose `here` to the next one, or from the previous one.
inline double speed(const Trajectory& reference, std::size_t here, bool is_ahead) {
  const bool is_last = here + 1 == reference.size();
  const std::size_t from = is_last || (!is_ahead && here > 0) ? here - 1 : here;
  const StampedPose& a = reference[from];
  const StampedPose& b = reference[from + 1];
  if (a.stamp == b.stamp) return 0.0;  // read for evo's association
  return (b.world_from_body.translation - a.world_from_body.translation).norm() /
         (b.stamp - a.stamp);
}

/// Position error that a perfect estimate would have with the pairs of `evaluation`: the distance
/// that the complete `reference` moves between the two stamps of a pair, at its speed from the
/// paired pose to its neighbour on that side. nullopt for associations `interpolate` and `index`.
/// O(n log m).
inline std::optional<AssociationError> association_error(const Trajectory& reference,
                                                         const Evaluation& evaluation) {
  const Protocol& protocol = evaluation.protocol;
  const bool has_differences =
      !interpolates(protocol.association) && protocol.association != Association::index;
  if (!has_differences || reference.size() < 2) return std::nullopt;
  AssociationError out;
  double squares = 0.0;
  std::size_t here = 0;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const double stamp = evaluation.reference[i].stamp;
    const double difference = evaluation.estimate[i].stamp + protocol.offset - stamp;
    if (difference == 0.0) continue;
    out.largest_difference = std::max(out.largest_difference, std::abs(difference));
    here = index_at(reference, stamp, here);
    const double metres = difference * speed(reference, here, difference > 0.0);
    squares += metres * metres;
  }
  out.metres = std::sqrt(squares / static_cast<double>(evaluation.reference.size()));
  return out;
}

}  // namespace loopbench::metrics
