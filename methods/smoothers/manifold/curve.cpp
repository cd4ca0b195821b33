#include "methods/smoothers/manifold/curve.hpp"

#include "datasets/core/knot_span.hpp"

namespace loopbench::methods::manifold {

ManifoldCurve::ManifoldCurve(const Trajectory& nodes, Parts parts)
    : stamps_(loopbench::stamps(nodes)), parts_(std::move(parts)) {
  rotation_steps_.reserve(nodes.size());
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Rotation& current = nodes[i].world_from_body.rotation;
    const Rotation& next = nodes[i + 1].world_from_body.rotation;
    rotation_steps_.push_back({current, log_so3(current.conjugate() * next)});
  }
}

MotionJet ManifoldCurve::motion(std::size_t edge, double time) const {
  return parts_.base + parts_.point(edge, time_jet(time));
}

Rotation ManifoldCurve::rotation(std::size_t edge, double time) const {
  const double u = (time - stamps_[edge]) / (stamps_[edge + 1] - stamps_[edge]);
  return rotation_steps_[edge].start * exp_so3(u * rotation_steps_[edge].turn);
}

void ManifoldCurve::sample(std::span<const double> times, std::span<Pose> poses) const {
  KnotSpan span(stamps_);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t edge = span.find(times[k]);
    poses[k] = {rotation(edge, times[k]), parts_.base + parts_.point(edge, times[k])};
  }
}

}  // namespace loopbench::methods::manifold
