#include "datasets/derive/view.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench {
namespace {

// Midpoints in azimuth, sine of elevation and cube of range: equal volumes.
constexpr int kAzimuths = 12, kElevations = 8, kRanges = 6;

double between(double low, double high, int index, int count) {
  return low + (high - low) * (index + 0.5) / count;
}

}  // namespace

SharedView::SharedView(const View& view) : view_(view), sine_(std::sin(0.5 * view.vertical)) {
  const double half = 0.5 * view.horizontal;
  const double first = std::pow(view.nearest, 3), last = std::pow(view.farthest, 3);
  for (int a = 0; a < kAzimuths; ++a) {
    const double azimuth = between(-half, half, a, kAzimuths);
    for (int e = 0; e < kElevations; ++e) {
      const double height = between(-sine_, sine_, e, kElevations);
      const double level = std::sqrt(1.0 - height * height);
      const double forward = level * std::cos(azimuth), aside = level * std::sin(azimuth);
      const Vector3 direction = view.axes == View::Axes::z_forward
                                    ? Vector3(aside, height, forward)
                                    : Vector3(forward, aside, height);
      for (int r = 0; r < kRanges; ++r) {
        points_.emplace_back(std::cbrt(between(first, last, r, kRanges)) * direction);
      }
    }
  }
}

bool SharedView::contains(const Vector3& point) const {
  const double range = point.norm();
  if (range < view_.nearest || range > view_.farthest) return false;
  const bool is_camera = view_.axes == View::Axes::z_forward;
  const double height = is_camera ? point.y() : point.z();
  if (std::abs(height) > range * sine_) return false;
  const double aside = is_camera ? point.x() : point.y();
  const double forward = is_camera ? point.z() : point.x();
  return 2.0 * std::abs(std::atan2(aside, forward)) <= view_.horizontal;
}

double SharedView::share(const Pose& to_from_from) const {
  const auto count = std::ranges::count_if(
      points_, [&](const Vector3& point) { return contains(to_from_from * point); });
  return static_cast<double>(count) / static_cast<double>(points_.size());
}

bool SharedView::is_seen_again(const Pose& to_from_from) const {
  return share(to_from_from) >= view_.share;
}

}  // namespace loopbench
