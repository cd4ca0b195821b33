/// Result of the manifold smoother: spline, planar pieces and heights as a function of time.
#pragma once

#include "datasets/core/knot_curve.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::methods::manifold {

struct Parts {
  Vector3 base;  ///< position of the first node [m]
  Vector3 up;
  NodeSpline spline;
  std::optional<PiecewiseCurve<PlanarPiece, Vector3>> planar;  ///< none: y' of the spline
  std::optional<PiecewiseCurve<Height, double>> spatial;       ///< none: z' of the spline

  /// Spline point with y' replaced by the planar piece, relative to `base`; `time` is a double or a
  /// Jet.
  template <class T>
  VectorOf<T> planar_point(std::size_t edge, const T& time) const {
    const SplinePointOf<T> position = spline.at(edge, time);
    if (!planar) return position.point;
    return planar->at(
        edge, time, [&](const PlanarPiece& piece) { return value_of_piece(piece, position); });
  }

  /// Point with y' and z' replaced.
  template <class T>
  VectorOf<T> point(std::size_t edge, const T& time) const {
    const VectorOf<T> out = planar_point(edge, time);
    if (!spatial) return out;
    const T own = along(up, out);
    const T height =
        spatial->at(edge, time, [&](const Height& piece) { return piece.over<T>(out, own); });
    return out + (height - own) * up;
  }
};

class ManifoldCurve final : public KnotCurve {
 public:
  /// Requires at least two nodes. Orientation is the slerp of theirs.
  ManifoldCurve(const Trajectory& nodes, Parts parts)
      : KnotCurve(stamps(nodes)), parts_(std::move(parts)) {
    rotation_steps_.reserve(nodes.size());
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const Rotation& current = nodes[i].world_from_body.rotation;
      const Rotation& next = nodes[i + 1].world_from_body.rotation;
      rotation_steps_.push_back({current, log_so3(current.conjugate() * next)});
    }
  }

  const Parts& parts() const { return parts_; }

  /// Position [m], velocity and acceleration (analytic), evaluated with the pieces of `edge` even
  /// at its end points. Evaluating both edges of a node gives the jump there.
  MotionJet motion(std::size_t edge, double time) const {
    return parts_.base + parts_.point(edge, time_jet(time));
  }

 private:
  Pose evaluate(std::size_t edge, double time) const override {
    const RotationStep& step = rotation_steps_[edge];
    return {step.start * exp_so3(fraction(edge, time) * step.rotation),
            parts_.base + parts_.point(edge, time)};
  }

  struct RotationStep {
    Rotation start;
    Vector3 rotation;  ///< rotation vector from `start` to the next node [rad]
  };
  std::vector<RotationStep> rotation_steps_;  ///< one per edge, so each logarithm is computed once
  Parts parts_;
};

}  // namespace loopbench::methods::manifold
