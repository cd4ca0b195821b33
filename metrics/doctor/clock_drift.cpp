#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/speed_match.hpp"
#include "metrics/doctor/time_offset.hpp"

namespace loopbench::metrics {

std::optional<StampRepair> check_clock_drift(const Trajectory& reference,
                                             const Trajectory& estimate) {
  constexpr double kLeast = 0.008, kOfInterval = 0.15;  // change of the offset [s]
  constexpr double kLeastRate = 3e-4;  // clocks of computers differ by 1e-4 at most
  constexpr double kMostRate = 0.01;
  constexpr double kDeviations = 6.0, kOfChange = 0.3;
  if (estimate.size() < 3 * kFewestCommonPoses || reference.size() < kFewestCommonPoses ||
      reference.front().stamp > estimate.back().stamp ||
      estimate.front().stamp > reference.back().stamp) {
    return std::nullopt;
  }
  const double searched =
      std::max(1.0, kMostRate * (estimate.back().stamp - estimate.front().stamp));
  std::array<TimeOffset, 3> offsets;
  std::array<double, 3> centres{};
  for (std::size_t part = 0; part < 3; ++part) {
    const auto at = [&](std::size_t i) {
      return estimate.begin() + static_cast<std::ptrdiff_t>(i * estimate.size() / 3);
    };
    const Trajectory third(at(part), at(part + 1));
    const auto found = estimate_time_offset(reference, third, searched);
    if (!found || !found->has_common_time) return std::nullopt;
    offsets[part] = *found;
    centres[part] = 0.5 * (third.front().stamp + third.back().stamp);
  }
  const double change = offsets[2].offset - offsets[0].offset;
  const double rate = change / (centres[2] - centres[0]);
  const double expected = offsets[0].offset + rate * (centres[1] - centres[0]);
  const double deviation = std::hypot(offsets[0].deviation, offsets[2].deviation);
  const double error = std::abs(offsets[1].offset - expected);
  if (std::abs(change) <
          std::max({kLeast, kOfInterval * usual_interval(estimate), kDeviations * deviation}) ||
      std::abs(rate) < kLeastRate || std::abs(rate) > kMostRate ||
      error > kOfChange * std::abs(change)) {
    return std::nullopt;
  }
  const double origin = estimate.front().stamp;
  const double at_zero = offsets[0].offset - rate * centres[0];  // for the stamp 0
  const double constant = SpeedMatch(reference, estimate).at(offsets[1].offset);
  const double drifting = SpeedMatch(reference, restamped(estimate, 1.0 + rate, at_zero)).at(0.0);
  if (drifting < constant) return std::nullopt;
  const double offset = offsets[0].offset + rate * (origin - centres[0]);
  return StampRepair{
      {Fault::clock_drift,
       fmt::format(
           "the estimate's clock drifts by {:.3f} %: its offset grows from {:.3f} to {:.3f} "
           "s; in the middle third, which was not used, offset {:.3f} -> {:.3f} s, correlation of "
           "speeds {:.3f} -> {:.3f}",
           100.0 * rate,
           offsets[0].offset,
           offsets[2].offset,
           offsets[1].offset,
           offsets[1].offset - expected,
           constant,
           drifting),
       fmt::format("correct its stamps t: t + {:.4f} + {:.6f} (t - {:.3f})", offset, rate, origin),
       1.0 - error / std::abs(change),
       rate},
      1.0 + rate,
      at_zero};
}

}  // namespace loopbench::metrics
