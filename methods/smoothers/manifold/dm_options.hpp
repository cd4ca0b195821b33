/// Every switch of the manifold smoother: the design's readings where the article is silent.
#pragma once

#include <string>

#include "datasets/core/fields.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/psi.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "methods/smoothers/manifold/short_segments.hpp"
#include "methods/smoothers/manifold/spatial.hpp"
#include "methods/smoothers/manifold/up.hpp"

namespace loopbench {

/// A rule: 0 for off, or low to high.
struct ZeroOr {
  int low, high;

  bool holds(double value) const { return value == 0.0 || (low <= value && value <= high); }
  std::string text(const std::string& name) const {
    return name + " = 0 or " + std::to_string(low) + " <= " + name + " <= " + std::to_string(high);
  }
};

struct DmOptions {
  int planar = 4;   ///< N, nodes of a planar window; 0: y' stays the spline's
  int spatial = 0;  ///< M, nodes of a spatial window; 0: z' stays the spline's
  manifold::SegmentRule segment = {};
  manifold::GapRule gap = {};
  /// [medians]; a pause of a few dozen is no gap: KITTI 07 stands for 37 of its keyframe intervals.
  std::optional<double> chord_above = 50.0;
  manifold::Up up = manifold::Up::pca;
  manifold::Fallback fallback = manifold::Fallback::arc;
  bool height_guard = true;  ///< surfaces that run away between nodes are not used

  manifold::Axes frame = manifold::Axes::chord;
  bool guard = true;
  manifold::Scheme scheme = manifold::Scheme::consecutive;
  std::string families = "by_n";
  manifold::FamilyRule family = {};
  manifold::Selection selection = manifold::Selection::fixed;
  double quadric_cut = manifold::kQuadricCut;
  manifold::Abscissa abscissa = manifold::Abscissa::spline;
  int spline_order = 4;
  manifold::JointRule joint = {};
  manifold::Short short_policy = manifold::Short::borrow_neighbours;
  int min_nodes = 0;
  manifold::PsiUse psi = manifold::PsiUse::none;
  manifold::PsiMean psi_mean = manifold::PsiMean::discrete;
  int psi_half_window = 2;
  bool report_coefficients = false;
  bool report_frames = false;
};

template <class Visit>
void fields(DmOptions& o, Visit visit) {
  visit("planar", o.planar, "N, nodes of a planar window (the article: 3 4 5)", ZeroOr{3, 12});
  visit("spatial", o.spatial, "M, nodes of a spatial window (the article: 6 7 8)", ZeroOr{6, 12});
  visit("gap_max",
        o.gap.time_max,
        "longer gaps take tracked frames as quasi-keyframes [s]; none: never",
        Above{0.0});
  visit("gap_rotation_max",
        o.gap.rotation_max,
        "so do gaps with more rotation, where no view is shared [rad]; none: never",
        Above{0.0});
  visit("gap_common_min",
        o.gap.common_min,
        "so do keyframes with fewer landmarks in common, where that is known; none: never",
        Above{0.0});
  visit("chord_above",
        o.chord_above,
        "longer intervals without tracked frames are chords [median keyframe intervals]; none: "
        "never",
        Above{0.0});
  visit("speed_rule", o.segment.speed, "when a speed fits a segment");
  visit("speed_band",
        o.segment.speed_band,
        "what the rule compares with [m/s]; none: the mean speed",
        Above{0.0});
  visit("kappa", o.segment.kappa, "what turning is measured by: rad, 1/m or rad/s");
  visit("kappa_plane", o.segment.plane, "of the path in space, or seen from above");
  visit("turn_max", o.segment.turn_max, "more kappa ends a segment [as kappa has it]", Above{0.0});
  visit("short_policy", o.short_policy, "what becomes of segments with fewer than min_nodes");
  visit("min_nodes", o.min_nodes, "nodes of a whole segment; 0: N, or M without N", ZeroOr{2, 100});
  visit("scheme", o.scheme, "how windows lie in a segment");
  visit("psi", o.psi, "where the optimal tangent is used: nowhere, or at segment ends (then C1)");
  visit("psi_mean", o.psi_mean, "best candidate, or mean direction on the sphere");
  visit("psi_half_window", o.psi_half_window, "steps looked at on each side", Between{1, 10});
  visit("abscissa", o.abscissa, "whose x' is used to find y'");
  visit(
      "spline_order", o.spline_order, "order k of that B-spline; 4: natural cubic", Between{2, 6});
  visit("frame", o.frame, "axes of a window; parametric: r(s) instead of y' = f(x')");
  visit("up", o.up, "z' of the fitting frames: axis of least variance, or the world's z");
  visit("guard", o.guard, "split windows that are no graph y' = f(x')");
  visit("families", o.families, "curve families in order of preference");
  visit("selection", o.selection, "the first that can be fitted, or the best on the keyframes");
  visit("implicit_order", o.family.implicit_order, "n of F(x, y) = 0", Between{1, 3});
  visit("level", o.family.level, "sin1 and rat02 get a constant of their own");
  visit("fallback", o.fallback, "where nodes are no graph: parabola in arc length, or the spline");
  visit("height_guard",
        o.height_guard,
        "drop a surface that leaves the spline by more than its nodes' range of heights");
  visit("quadric_cut",
        o.quadric_cut,
        "weaker directions of a quadric are dropped [of the strongest]",
        Between{0.0, 1.0});
  visit("joint", o.joint.meet, "how neighbouring pieces meet");
  visit("low_speed_c0_below",
        o.joint.c0_below,
        "slower joints only meet in position [m/s]; none: no such",
        Above{0.0});
  visit("report_coefficients", o.report_coefficients, "a note for every window's coefficients");
  visit("report_frames", o.report_frames, "count curvature, torsion and undefined Frenet frames");
}

}  // namespace loopbench
