/// Spline bases with fewer functions than keyframes, and their initial controls.
#pragma once

#include <cmath>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods {

/// Returns a basis with `share` functions per keyframe, at least k and at most n. Its sites are
/// evenly spaced by keyframe index, so knots are dense where keyframes are dense. Requires n >= k.
/// share = 1 equals for_sites.
inline SplineBasis basis_with_fewer_knots(std::size_t order,
                                          const std::vector<double>& stamps,
                                          double share) {
  const std::size_t n = stamps.size();
  const auto requested = static_cast<std::size_t>(std::lround(share * static_cast<double>(n)));
  const std::size_t count = std::clamp(requested, order, n);
  std::vector<double> sites{stamps.front()};
  for (std::size_t j = 1; j + 1 < count; ++j) {
    const std::size_t scaled_index = j * (n - 1);
    const std::size_t i = scaled_index / (count - 1);
    const double u =
        static_cast<double>(scaled_index % (count - 1)) / static_cast<double>(count - 1);
    sites.push_back(u > 0.0 ? stamps[i] + u * (stamps[i + 1] - stamps[i]) : stamps[i]);
  }
  sites.push_back(stamps.back());
  return SplineBasis::for_sites(order, sites);
}

/// Initial controls: the keyframes' polyline at the Greville abscissae, which is exact for uniform
/// motion.
inline std::vector<Pose> initial_controls_for(const SplineBasis& basis,
                                              const Trajectory& keyframes) {
  std::vector<double> times;
  for (std::size_t j = 0; j < basis.size(); ++j) times.push_back(basis.greville(j));
  times.front() = keyframes.front().stamp;
  times.back() = keyframes.back().stamp;
  std::vector<Pose> out(times.size());
  Polyline(keyframes).sample(times, out);
  return out;
}

}  // namespace loopbench::methods
