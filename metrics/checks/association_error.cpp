#include "metrics/checks/association_error.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::metrics {
namespace {

/// Speed [m/s] from the pose at `stamp` to the next one, or from the previous one.
double speed(const Trajectory& reference, double stamp, bool is_ahead) {
  const auto here = std::ranges::lower_bound(reference, stamp, {}, &StampedPose::stamp);
  const auto last = reference.end() - 1;
  auto from = std::min(here, last);
  if (from == last || (!is_ahead && from != reference.begin())) --from;
  const StampedPose& a = *from;
  const StampedPose& b = *(from + 1);
  return (b.world_from_body.translation - a.world_from_body.translation).norm() /
         (b.stamp - a.stamp);
}

}  // namespace

std::optional<AssociationError> association_error(const Trajectory& reference,
                                                  const Evaluation& evaluation) {
  const Protocol& protocol = evaluation.protocol;
  const bool has_differences = protocol.association != Association::interpolate &&
                               protocol.association != Association::index;
  if (!has_differences || reference.size() < 2) return std::nullopt;
  AssociationError out;
  double squares = 0.0;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const double stamp = evaluation.reference[i].stamp;
    const double difference = evaluation.estimate[i].stamp + protocol.offset - stamp;
    if (difference == 0.0) continue;
    out.largest_difference = std::max(out.largest_difference, std::abs(difference));
    const double metres = difference * speed(reference, stamp, difference > 0.0);
    squares += metres * metres;
  }
  out.metres = std::sqrt(squares / static_cast<double>(evaluation.reference.size()));
  return out;
}

}  // namespace loopbench::metrics
