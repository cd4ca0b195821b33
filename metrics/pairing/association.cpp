#include "metrics/pairing/association.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/parallel.hpp"

namespace loopbench::metrics {
namespace {

/// Visits (index in wanted, index in stamps) of each requested stamp and its nearest stamp.
template <class Visit>
void for_each_nearest(const std::vector<double>& wanted,
                      const std::vector<double>& stamps,
                      double max_diff,
                      Visit visit) {
  if (stamps.empty()) return;
  std::size_t after = 0;  // first stamp not before the requested one
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    while (after < stamps.size() && stamps[after] < wanted[i]) ++after;
    std::size_t nearest = after;
    if (after == stamps.size() ||
        (after > 0 && wanted[i] - stamps[after - 1] <= stamps[after] - wanted[i])) {
      nearest = after - 1;
      while (nearest > 0 && stamps[nearest - 1] == stamps[nearest]) --nearest;
    }
    if (std::abs(stamps[nearest] - wanted[i]) <= max_diff) visit(i, nearest);
  }
}

Trajectory gather(const Trajectory& from,
                  const std::vector<IndexPair>& pairs,
                  std::size_t IndexPair::*index) {
  Trajectory out;
  out.reserve(pairs.size());
  for (const IndexPair& pair : pairs) out.push_back(from[pair.*index]);
  return out;
}

Paired gather(const Trajectory& reference,
              const Trajectory& estimate,
              const std::vector<IndexPair>& pairs) {
  Paired out;
  const auto side = [&](std::size_t k) {
    if (k == 0) out.reference = gather(reference, pairs, &IndexPair::reference);
    if (k == 1) out.estimate = gather(estimate, pairs, &IndexPair::estimate);
  };
  if (pairs.size() >= kMinItemsPerThread) {
    parallel_invoke(2, side);
  } else {
    side(0);
    side(1);
  }
  return out;
}

}  // namespace

std::vector<IndexPair> match_evo(std::vector<double> reference,
                                 std::vector<double> estimate,
                                 double max_diff,
                                 double offset) {
  std::vector<IndexPair> out;
  out.reserve(std::min(reference.size(), estimate.size()));
  if (estimate.size() > reference.size()) {
    for (double& stamp : estimate) stamp += offset;
    for_each_nearest(reference, estimate, max_diff, [&](std::size_t short_i, std::size_t long_i) {
      out.push_back({short_i, long_i});
    });
  } else {
    for (double& stamp : reference) stamp -= offset;
    for_each_nearest(estimate, reference, max_diff, [&](std::size_t short_i, std::size_t long_i) {
      out.push_back({long_i, short_i});
    });
  }
  return out;
}

Paired interpolate_reference(const Trajectory& reference,
                             const Trajectory& estimate,
                             double max_gap,
                             double offset) {
  Paired out;
  out.reference.reserve(estimate.size());
  out.estimate.reserve(estimate.size());
  std::size_t after = 0;
  for (const StampedPose& pose : estimate) {
    const double stamp = pose.stamp + offset;
    const auto found = pose_at(reference, stamp, max_gap + kStampRounding, after);
    if (!found) continue;
    out.reference.push_back({stamp, *found});
    out.estimate.push_back(pose);
  }
  return out;
}

Paired interpolate_estimate(const Trajectory& reference,
                            const Trajectory& estimate,
                            double max_gap,
                            double offset) {
  Paired out = interpolate_reference(estimate, reference, max_gap, -offset);
  std::swap(out.reference, out.estimate);
  return out;
}

Paired associate(const Trajectory& reference,
                 const Trajectory& estimate,
                 const Protocol& protocol) {
  const double max_diff = protocol.max_diff;
  const double offset = protocol.offset;
  switch (protocol.association) {
    case Association::interpolate:
      return interpolate_reference(reference, estimate, protocol.max_gap, offset);
    case Association::interpolate_estimate:
      return interpolate_estimate(reference, estimate, protocol.max_gap, offset);
    case Association::evo:
      return gather(
          reference, estimate, match_evo(stamps(reference), stamps(estimate), max_diff, offset));
    case Association::index:
      if (reference.empty() || estimate.empty()) return {};
      if (reference.size() == estimate.size()) return {reference, estimate};
      throw std::runtime_error("association index: the reference has " +
                               std::to_string(reference.size()) + " poses and the estimate " +
                               std::to_string(estimate.size()) + ", expected equal numbers");
    case Association::tum:
    case Association::nearest:
      break;
  }
  const bool is_tum = protocol.association == Association::tum;
  const Limit limit = is_tum ? Limit::strict : Limit::inclusive;
  const Crossing crossing = is_tum ? Crossing::allowed : Crossing::refused;
  return gather(
      reference,
      estimate,
      match_one_to_one(stamps(reference), stamps(estimate), max_diff, limit, crossing, offset));
}

}  // namespace loopbench::metrics
