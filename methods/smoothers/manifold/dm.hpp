/// The paper's smoother, "Loop Closure Detection Based on Differentiable Manifold", read robustly.
///
/// Despite that title it detects no loops: it takes a keyframe trajectory as it is, cuts it where
/// speed or direction change, and between N (planar) or M (spatial) nodes at a time replaces y'
/// by a curve f(x') and z' by a surface q(x', y'). Orientation passes through.
#pragma once

#include <algorithm>
#include <array>

#include "methods/method.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "methods/smoothers/manifold/up.hpp"

namespace loopbench {

/// A rule: one of these numbers.
struct OneOf {
  std::array<int, 4> allowed;

  bool holds(double value) const {
    return std::any_of(allowed.begin(), allowed.end(), [&](int one) { return one == value; });
  }
  std::string text(const std::string& name) const {
    std::string out = name + " in";
    for (const int one : allowed) (out += ' ') += std::to_string(one);
    return out;
  }
};

class Dm final : public Smoother {
 public:
  struct Options {
    int planar = 4;   ///< N, nodes of a planar window; 0: y' stays the spline's
    int spatial = 0;  ///< M, nodes of a spatial window; 0: z' stays the spline's
    manifold::SegmentRule segment = {};
    manifold::GapRule gap = {};
    manifold::Up up = manifold::Up::pca;
    manifold::Fallback fallback = manifold::Fallback::arc;
    bool height_guard = true;  ///< surfaces that run away between nodes are not used
  };
  explicit Dm(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// O(keyframes log frames). Counts nodes, quasi_keyframes, gaps_left, segments and, when the
  /// stage is on, windows, split_windows, fallbacks, mean_window_nodes, spatial_windows,
  /// spatial_truncated, spatial_fallbacks. Fewer than three nodes give the polyline.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(Dm::Options& o, Visit visit) {
  visit("planar", o.planar, "N, nodes of a planar window; 0: off", OneOf{{0, 3, 4, 5}});
  visit("spatial", o.spatial, "M, nodes of a spatial window; 0: off", OneOf{{0, 6, 7, 8}});
  visit("speed_band",
        o.segment.speed_band,
        "range of speeds inside a segment [m/s]; none: the mean speed",
        Above{0.0});
  visit("turn_max",
        o.segment.turn_max,
        "turn between two steps that ends a segment [rad per keyframe]",
        Above{0.0});
  visit("gap_max",
        o.gap.time_max,
        "longer gaps take tracked frames as quasi-keyframes [s]; none: never",
        Above{0.0});
  visit("gap_rotation_max",
        o.gap.rotation_max,
        "so do gaps with more rotation, where no view is shared [rad]; none: never",
        Above{0.0});
  visit("up", o.up, "z' of the fitting frames: axis of least variance, or the world's z");
  visit("fallback", o.fallback, "where nodes are no graph: parabola in arc length, or the spline");
  visit("height_guard",
        o.height_guard,
        "drop a surface that leaves the spline by more than its nodes' range of heights");
}

}  // namespace loopbench
