#include "methods/correctors/anchored_chain.hpp"

#include <algorithm>

namespace loopbench::methods {
namespace {

/// Edge from the first keyframe to that of the anchor.
Edge edge_of(const Anchor& anchor, const Pose& world_from_first) {
  const Matrix3 R = world_from_first.rotation.toRotationMatrix();
  Edge out{0, anchor.keyframe, {}};
  out.from_from_to.translation = world_from_first.inverse() * anchor.position;
  out.information.topLeftCorner<3, 3>() = R.transpose() * anchor.covariance.inverse() * R;
  return out;
}

/// Largest distance from the first keyframe, at least 1 [m].
double size_of(const Trajectory& keyframes) {
  double out = 1.0;
  for (const StampedPose& each : keyframes) {
    const Vector3 offset =
        each.world_from_body.translation - keyframes.front().world_from_body.translation;
    out = std::max(out, offset.norm());
  }
  return out;
}

}  // namespace

AnchoredChain::AnchoredChain(const Problem& of, const UsedAnchors& used)
    : has_front(used.is_first_free), size_(size_of(of.keyframes)) {
  problem.planar = of.planar;
  problem.keyframes = of.keyframes;
  problem.odometry = of.odometry;
  problem.closures = of.closures;
  points.resize(of.closures.size());
  const Pose& first = of.keyframes.front().world_from_body;
  for (const Anchor& anchor : used.anchors) {
    problem.closures.push_back(edge_of(anchor, first));
    points.emplace_back(anchor.point_in_body);
  }
  if (!has_front) return;
  for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) ++edge.from, ++edge.to;
  }
  for (std::size_t k = of.closures.size(); k < problem.closures.size(); ++k) {
    problem.closures[k].from = 0;
  }
  problem.keyframes.insert(problem.keyframes.begin(), problem.keyframes.front());
  Edge wide{0, 1, {}};
  wide.information.topLeftCorner<3, 3>() /= size_ * size_;
  problem.odometry.insert(problem.odometry.begin(), wide);
}

Trajectory AnchoredChain::without_front(Trajectory keyframes) const {
  if (has_front) keyframes.erase(keyframes.begin());
  return keyframes;
}

}  // namespace loopbench::methods
