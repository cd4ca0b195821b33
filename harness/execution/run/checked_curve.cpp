#include "harness/execution/run/checked_curve.hpp"

#include <limits>
#include <stdexcept>

#include "datasets/core/pose_rule.hpp"

namespace loopbench::harness {

void CheckedCurve::sample(std::span<const double> times, std::span<Pose> poses) const {
  constexpr double kNotWritten = std::numeric_limits<double>::quiet_NaN();
  for (Pose& pose : poses) pose.translation.setConstant(kNotWritten);
  curve_.sample(times, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string rule = violated_rule(poses[i]);
    if (rule.empty()) continue;
    const std::string error = "the curve at " + to_text(times[i]) + " s: " + rule;
    const std::lock_guard lock(mutex_);
    if (first_error_.empty()) first_error_ = error;
    throw std::runtime_error(error);
  }
}

void CheckedCurve::require_valid_so_far() const {
  const std::lock_guard lock(mutex_);
  if (!first_error_.empty()) throw std::runtime_error(first_error_);
}

}  // namespace loopbench::harness
