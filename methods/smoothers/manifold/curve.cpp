#include "methods/smoothers/manifold/curve.hpp"

#include "datasets/core/knot_span.hpp"

namespace loopbench::manifold {

ManifoldCurve::ManifoldCurve(const Trajectory& nodes, Parts parts)
    : stamps_(stamps(nodes)), parts_(std::move(parts)) {
  arms_.reserve(nodes.size());
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Rotation& here = nodes[i].world_from_body.rotation;
    const Rotation& next = nodes[i + 1].world_from_body.rotation;
    arms_.push_back({here, log_so3(here.conjugate() * next)});
  }
}

Vector3 ManifoldCurve::position(std::size_t edge, double time) const {
  const Place place = parts_.spline.at(edge, time);
  Vector3 point = place.point;
  if (parts_.planar) {
    point = parts_.planar->at(edge, time, [&](const PlanarPiece& piece) {
      return std::visit([&](const auto& shape) { return shape(place); }, piece);
    });
  }
  if (parts_.spatial) {
    const double own = parts_.up.dot(point);
    const double height =
        parts_.spatial->at(edge, time, [&](const Height& piece) { return piece.over(point, own); });
    point += (height - own) * parts_.up;
  }
  return parts_.base + point;
}

Rotation ManifoldCurve::rotation(std::size_t edge, double time) const {
  const double u = (time - stamps_[edge]) / (stamps_[edge + 1] - stamps_[edge]);
  return arms_[edge].start * exp_so3(u * arms_[edge].turn);
}

void ManifoldCurve::sample(std::span<const double> times, std::span<Pose> poses) const {
  KnotSpan span(stamps_);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t edge = span.find(times[k]);
    poses[k] = {rotation(edge, times[k]), position(edge, times[k])};
  }
}

}  // namespace loopbench::manifold
