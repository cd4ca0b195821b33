#include "datasets/derive/closures.hpp"

#include <algorithm>
#include <tuple>

#include "datasets/derive/odometry.hpp"
#include "datasets/random.hpp"

namespace loopbench {
namespace {

/// Poses of a run at keyframe stamps, where available.
struct RunAtKeyframes {
  Trajectory run;
  std::vector<std::size_t> keyframe;  ///< keyframe index of each pose
};

RunAtKeyframes at_keyframes(const Trajectory& keyframes,
                            const Trajectory& run,
                            const InterpolationLimits& reach) {
  const auto poses = poses_at(run, stamps(keyframes), reach);
  RunAtKeyframes out;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!poses[i]) continue;
    out.run.push_back({keyframes[i].stamp, *poses[i]});
    out.keyframe.push_back(i);
  }
  return out;
}

}  // namespace

std::vector<Edge> measure_closures_in_run(const Trajectory& keyframes,
                                          const Trajectory& run,
                                          const RevisitRule& rule,
                                          std::size_t max,
                                          const InterpolationLimits& reach,
                                          const ClosureNoise& noise) {
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  const std::vector<Revisit> revisits = find_revisits(shared.run, rule);
  const Matrix6 information =
      isotropic_information(noise.sigma_t * noise.sigma_t, noise.sigma_r * noise.sigma_r);
  std::vector<Edge> closures;
  for (const std::size_t k :
       subsample(revisits, stamps(shared.run), max == 0 ? revisits.size() : max)) {
    const auto [from, to] = revisits[k];
    const Pose from_from_to =
        shared.run[from].world_from_body.inverse() * shared.run[to].world_from_body;
    closures.push_back(
        {shared.keyframe[from], shared.keyframe[to], normalized(from_from_to), information});
  }
  return closures;
}

std::vector<Edge> with_noise(std::vector<Edge> edges,
                             const ClosureNoise& noise,
                             const NoiseStream& stream) {
  Random random(stream, Purpose::closures);
  for (Edge& edge : edges) {
    const Twist error = random.normal_twist(noise.sigma_t, noise.sigma_r);
    edge.from_from_to = normalized(edge.from_from_to * exp_se3(error));
  }
  return edges;
}

double path_length_ratio(const Trajectory& keyframes,
                         const Trajectory& run,
                         const InterpolationLimits& reach) {
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  Trajectory estimate;
  for (const std::size_t i : shared.keyframe) estimate.push_back(keyframes[i]);
  const double length = path_length(estimate);
  return length > 0.0 ? path_length(shared.run) / length : 1.0;
}

std::vector<Edge> with_local_scale(std::vector<Edge> edges,
                                   const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const InterpolationLimits& reach) {
  // [keyframes]; scale drifts slowly, while the length of a single step is noisy
  constexpr std::size_t kHalfWindow = 10;
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  std::vector<double> estimate{0.0}, other{0.0};  // cumulative distance travelled
  for (std::size_t k = 1; k < shared.keyframe.size(); ++k) {
    const auto step = [](const StampedPose& a, const StampedPose& b) {
      return (b.world_from_body.translation - a.world_from_body.translation).norm();
    };
    estimate.push_back(estimate.back() +
                       step(keyframes[shared.keyframe[k - 1]], keyframes[shared.keyframe[k]]));
    other.push_back(other.back() + step(shared.run[k - 1], shared.run[k]));
  }
  const auto scale_at = [&](std::size_t keyframe) {
    const auto found = std::lower_bound(shared.keyframe.begin(), shared.keyframe.end(), keyframe);
    const auto k = static_cast<std::size_t>(found - shared.keyframe.begin());
    const std::size_t first = k < kHalfWindow ? 0 : k - kHalfWindow;
    const std::size_t last = std::min(k + kHalfWindow, shared.keyframe.size() - 1);
    const double length = estimate[last] - estimate[first];
    const double other_length = other[last] - other[first];
    if (!(length > 0.0) || !(other_length > 0.0)) {
      throw InputError(
          "keyframe " + std::to_string(keyframe) +
          ": found no motion around it, expected motion in both runs to compare their scales");
    }
    return other_length / length;
  };
  for (Edge& edge : edges) {
    const double from = scale_at(edge.from);
    edge.scale = scale_at(edge.to) / from;
    edge.from_from_to.translation /= from;
  }
  return edges;
}

void sort_closures(std::vector<Edge>& closures) {
  std::stable_sort(closures.begin(), closures.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.to, a.from) < std::tie(b.to, b.from);
  });
}

}  // namespace loopbench
