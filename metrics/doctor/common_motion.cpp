#include "metrics/doctor/common_motion.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench::metrics {

double median_value(std::vector<double> values) {
  return values.empty() ? 0.0 : upper_median(values);
}

double usual_interval(const Trajectory& poses) {
  constexpr std::size_t kMostSteps = 20'000;
  if (poses.size() < 2) return 0.0;
  const std::size_t step = (poses.size() - 2) / kMostSteps + 1;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); i += step) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return median_value(std::move(intervals));
}

namespace {

/// Standard deviation of the white noise of positions [m], over all three axes: from the median
/// distance of a position from the line between the ones before and after. Acceleration adds to it.
double position_noise(const Trajectory& poses) {
  constexpr double kMeanOverMedian = 3.0 / 2.366;  // of chi-squared with 3 degrees of freedom
  std::vector<double> squares;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const auto& [t0, before] = poses[i - 1];
    const auto& [t1, after] = poses[i + 1];
    const double u = t1 > t0 ? (poses[i].stamp - t0) / (t1 - t0) : 0.5;
    const Vector3 between = (1.0 - u) * before.translation + u * after.translation;
    squares.push_back((poses[i].world_from_body.translation - between).squaredNorm() /
                      (1.0 + (1.0 - u) * (1.0 - u) + u * u));
  }
  return std::sqrt(kMeanOverMedian * median_value(std::move(squares)));
}

}  // namespace

bool is_at_rest(const Trajectory& poses) {
  constexpr double kRounding = 1e-9;
  const auto n = static_cast<double>(poses.size());
  Vector3 mean = Vector3::Zero();
  for (const StampedPose& pose : poses) mean += pose.world_from_body.translation / n;
  double variance = 0.0;
  for (const StampedPose& pose : poses) {
    variance += (pose.world_from_body.translation - mean).squaredNorm() / n;
  }
  return std::sqrt(variance) <= kLeastOfNoise * position_noise(poses) + kRounding * mean.norm();
}

std::size_t first_from(const Trajectory& poses, double stamp, std::size_t hint) {
  const auto is_before = [&](std::size_t i) { return poses[i].stamp < stamp; };
  std::size_t low = std::min(hint, poses.size());  // all before `low` are before the stamp
  std::size_t high = low;                          // `high` is not, or is the end
  for (std::size_t step = 1; high < poses.size() && is_before(high); step *= 2) {
    low = high + 1;
    high = std::min(poses.size(), high + step);
  }
  for (std::size_t step = 1; low > 0 && !is_before(low - 1); step *= 2) {
    high = low - 1;
    low -= std::min(low, step);
  }
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (is_before(middle)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t kFewest = 5;
  if (a.size() != b.size() || a.size() < kFewest) return 0.0;
  const auto n = static_cast<double>(a.size());
  double mean_a = 0.0, mean_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

CommonPoses common_poses(const Trajectory& reference,
                         const Trajectory& estimate,
                         double offset,
                         std::size_t most) {
  CommonPoses out;
  if (reference.size() < 2 || estimate.empty()) return out;
  const double longest = std::max(1.0, 10.0 * usual_interval(reference));
  const std::size_t step = std::max<std::size_t>(1, (estimate.size() + most - 1) / most);
  std::size_t after = 1;
  for (std::size_t i = 0; i < estimate.size(); i += step) {
    const double stamp = estimate[i].stamp + offset;
    after =
        std::clamp<std::size_t>(first_from(reference, stamp, after), after, reference.size() - 1);
    const StampedPose& a = reference[after - 1];
    const StampedPose& b = reference[after];
    if (stamp < a.stamp || stamp > b.stamp || b.stamp - a.stamp > longest) continue;
    const double u = (stamp - a.stamp) / (b.stamp - a.stamp);
    out.reference.push_back(interpolate(a.world_from_body, b.world_from_body, u));
    out.estimate.push_back(estimate[i].world_from_body);
    out.stamps.push_back(estimate[i].stamp);
  }
  return out;
}

}  // namespace loopbench::metrics
