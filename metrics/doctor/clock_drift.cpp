#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/time_offset.hpp"

namespace loopbench::metrics {

std::optional<StampRepair> check_clock_drift(const Trajectory& reference,
                                             const Trajectory& estimate) {
  constexpr double kLeast = 0.015, kOfInterval = 0.1, kDeviations = 3.0;  // of the change [s]
  constexpr double kLeastRate = 5e-4;  // clocks of computers differ by 1e-4 at most
  constexpr double kMostRate = 0.01, kOfChange = 0.3;
  constexpr double kMostOfRotation = 0.98, kMostOfPosition = 0.5;  // of the error before
  constexpr std::size_t kParts = 3;
  const std::size_t n = estimate.size();
  if (n < kParts * kFewestCommonPoses) return std::nullopt;
  const double origin = estimate.front().stamp;
  const double searched = std::max(1.0, kMostRate * (estimate.back().stamp - origin));
  std::array<TimeOffset, kParts> found;
  std::array<double, kParts> centres{};
  for (std::size_t i = 0; i < kParts; ++i) {
    const auto at = [&](std::size_t part) {
      return estimate.begin() + static_cast<std::ptrdiff_t>(part * n / kParts);
    };
    const Trajectory third(at(i), at(i + 1));
    const auto offset = estimate_time_offset(reference, third, searched);
    if (!offset || !offset->has_common_time) return std::nullopt;
    found[i] = *offset;
    centres[i] = 0.5 * (third.front().stamp + third.back().stamp);
  }
  const double change = found[2].offset - found[0].offset;
  const double rate = change / (centres[2] - centres[0]);
  const auto drifted = [&](double stamp) { return found[0].offset + rate * (stamp - centres[0]); };
  const double error = std::abs(found[1].offset - drifted(centres[1]));
  const double deviation = std::hypot(found[0].deviation, found[2].deviation);
  if (std::abs(change) <
          std::max({kLeast, kOfInterval * usual_interval(estimate), kDeviations * deviation}) ||
      std::abs(rate) < kLeastRate || std::abs(rate) > kMostRate ||
      error > kOfChange * std::abs(change)) {
    return std::nullopt;
  }
  Trajectory corrected = restamped(estimate, 1.0 + rate, drifted(0.0));
  const Agreement before =
      agreement(common_poses(reference, estimate, found[1].offset, kMostCommonPoses));
  const Agreement after = agreement(common_poses(reference, corrected, 0.0, kMostCommonPoses));
  const bool by_rotation = before.has_rotations;
  const double ratio =
      by_rotation ? after.turning / before.turning : after.similarity / before.similarity;
  if (!(ratio < (by_rotation ? kMostOfRotation : kMostOfPosition))) return std::nullopt;
  return StampRepair{
      {Fault::clock_drift,
       fmt::format("the estimate's clock drifts by {:.3f} %: its offset grows from {:.3f} to "
                   "{:.3f} s; {}",
                   100.0 * rate,
                   found[0].offset,
                   found[2].offset,
                   by_rotation ? fmt::format("error of relative rotations {:.1f} -> {:.1f} %",
                                             100.0 * before.turning,
                                             100.0 * after.turning)
                               : fmt::format("position error {:.3g} -> {:.3g} m",
                                             before.similarity,
                                             after.similarity)),
       fmt::format(
           "correct its stamps t: t + {:.4f} + {:.6f} (t - {:.3f})", drifted(origin), rate, origin),
       1.0 - error / std::abs(change),
       rate},
      1.0 + rate,
      drifted(0.0)};
}

}  // namespace loopbench::metrics
