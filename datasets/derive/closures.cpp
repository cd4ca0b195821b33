#include "datasets/derive/closures.hpp"

#include <algorithm>
#include <tuple>

#include "datasets/derive/odometry.hpp"
#include "datasets/random.hpp"

namespace loopbench {
namespace {

struct Seen {
  Trajectory run;                     ///< the run at those keyframe stamps where it is known
  std::vector<std::size_t> keyframe;  ///< which keyframe each is
};

Seen at_keyframes(const Trajectory& keyframes, const Trajectory& run, const Reach& reach) {
  const auto poses = poses_at(run, stamps(keyframes), reach);
  Seen seen;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!poses[i]) continue;
    seen.run.push_back({keyframes[i].stamp, *poses[i]});
    seen.keyframe.push_back(i);
  }
  return seen;
}

}  // namespace

std::vector<Edge> closures_in_run(const Trajectory& keyframes,
                                  const Trajectory& run,
                                  const RevisitRule& rule,
                                  std::size_t max,
                                  const Reach& reach,
                                  const ClosureNoise& noise) {
  const Seen seen = at_keyframes(keyframes, run, reach);
  const std::vector<Revisit> revisits = find_revisits(seen.run, rule);
  const Matrix6 information =
      isotropic_information(noise.sigma_t * noise.sigma_t, noise.sigma_r * noise.sigma_r);
  std::vector<Edge> closures;
  for (const std::size_t k : spread(revisits, stamps(seen.run), max == 0 ? revisits.size() : max)) {
    const auto [from, to] = revisits[k];
    const Pose from_from_to =
        seen.run[from].world_from_body.inverse() * seen.run[to].world_from_body;
    closures.push_back(
        {seen.keyframe[from], seen.keyframe[to], normalized(from_from_to), information});
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

double path_ratio(const Trajectory& keyframes, const Trajectory& run, const Reach& reach) {
  const Seen seen = at_keyframes(keyframes, run, reach);
  Trajectory shared;
  for (const std::size_t i : seen.keyframe) shared.push_back(keyframes[i]);
  const double ours = path_length(shared);
  return ours > 0.0 ? path_length(seen.run) / ours : 1.0;
}

std::vector<Edge> with_local_scale(std::vector<Edge> edges,
                                   const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const Reach& reach) {
  constexpr std::size_t kAround = 10;  // keyframes: a unit creeps slowly, a step is measured badly
  const Seen seen = at_keyframes(keyframes, run, reach);
  std::vector<double> ours{0.0}, theirs{0.0};  // way so far
  for (std::size_t k = 1; k < seen.keyframe.size(); ++k) {
    const auto step = [](const StampedPose& a, const StampedPose& b) {
      return (b.world_from_body.translation - a.world_from_body.translation).norm();
    };
    ours.push_back(ours.back() +
                   step(keyframes[seen.keyframe[k - 1]], keyframes[seen.keyframe[k]]));
    theirs.push_back(theirs.back() + step(seen.run[k - 1], seen.run[k]));
  }
  const auto unit_at = [&](std::size_t keyframe) {
    const auto place = std::lower_bound(seen.keyframe.begin(), seen.keyframe.end(), keyframe);
    const auto k = static_cast<std::size_t>(place - seen.keyframe.begin());
    const std::size_t first = k < kAround ? 0 : k - kAround;
    const std::size_t last = std::min(k + kAround, seen.keyframe.size() - 1);
    const double way = ours[last] - ours[first], their_way = theirs[last] - theirs[first];
    if (!(way > 0.0) || !(their_way > 0.0)) {
      throw InputError("keyframe " + std::to_string(keyframe) +
                       ": stands still, so that its unit of length cannot be compared");
    }
    return their_way / way;
  };
  for (Edge& edge : edges) {
    const double from = unit_at(edge.from);
    edge.scale = unit_at(edge.to) / from;
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
