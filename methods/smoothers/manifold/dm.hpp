/// The article's smoother, "Loop Closure Detection Based on Differentiable Manifold".
///
/// Despite its title it does not detect loops. It splits a keyframe trajectory where speed or
/// direction changes. On windows of N (planar) or M (spatial) nodes it replaces y' by a curve f(x')
/// and z' by a surface q(x', y'). Orientation is not changed. The defaults are a robust
/// interpretation of the article; the literal interpretation is a set of options
/// (results/paper/plugin). The abscissa is always that of the estimate, because a method has no
/// access to the reference.
#pragma once

#include <string>

#include "datasets/core/fields.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/fit_axes.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/psi.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::methods {

/// Rule: value is 0 (off) or in low..high.
struct ZeroOr {
  int low, high;

  bool holds(double value) const { return value == 0.0 || (low <= value && value <= high); }
  OptionRange range() const { return {0.0, static_cast<double>(high)}; }
  std::string text(const std::string& name) const {
    return name + " = 0 or " + std::to_string(low) + " <= " + name + " <= " + std::to_string(high);
  }
};

struct DmOptions {
  int planar = 4;   ///< N, nodes of a planar window; 0: keep y' of the spline
  int spatial = 0;  ///< M, nodes of a spatial window; 0: keep z' of the spline
  manifold::SegmentRule segment = {};
  manifold::GapRule gap = {};
  /// [median intervals]; above the pauses in real data: KITTI 07 is at rest for 37 keyframe
  /// intervals.
  std::optional<double> chord_above = 50.0;
  manifold::UpDirection up = manifold::UpDirection::pca;
  manifold::Fallback fallback = manifold::Fallback::arc;
  bool height_guard = true;  ///< reject surfaces that leave the spline between nodes

  manifold::Axes frame = manifold::Axes::chord;
  manifold::FitAxes fit_axes = manifold::FitAxes::estimate;
  manifold::Plane plane = manifold::Plane::xoy;
  bool guard = true;
  manifold::Scheme scheme = manifold::Scheme::consecutive;
  std::string families = "by_n";
  manifold::Selection selection = manifold::Selection::fixed;
  double quadric_cut = manifold::kQuadricCut;
  manifold::Abscissa abscissa = manifold::Abscissa::spline;
  int spline_order = 4;
  manifold::JointRule joint = {};
  manifold::ShortPolicy short_policy = manifold::ShortPolicy::borrow_neighbours;
  int min_nodes = 0;
  manifold::PsiUse psi = manifold::PsiUse::none;
  manifold::PsiMean psi_mean = manifold::PsiMean::discrete;
};

template <class Visit>
void fields(DmOptions& o, Visit visit) {
  visit("planar",
        o.planar,
        "N, number of nodes of a planar window (article: 3, 4, 5); 0: keep y' of the spline",
        ZeroOr{3, 12});
  visit("spatial",
        o.spatial,
        "M, number of nodes of a spatial window (article: 6, 7, 8); 0: keep z' of the spline",
        ZeroOr{6, 12});
  visit("gap_max",
        o.gap.time_max,
        "maximum time between keyframes without inserting tracked frames as nodes [s]; none: no "
        "limit",
        GreaterThan{0.0});
  visit("gap_rotation_max",
        o.gap.rotation_max,
        "maximum rotation between keyframes without inserting tracked frames as nodes [rad]; none: "
        "no limit",
        GreaterThan{0.0});
  visit("gap_common_min",
        o.gap.common_min,
        "minimum number of common landmarks of two keyframes without inserting tracked frames as "
        "nodes, if known; none: no limit",
        GreaterThan{0.0});
  visit("chord_above",
        o.chord_above,
        "maximum interval between nodes, above which a straight chord bridges it [median keyframe "
        "intervals]; none: no limit",
        GreaterThan{0.0});
  visit("speed_rule",
        o.segment.speed,
        "edges of a segment by their speed; range: all within a range of speed_band; adjacent: "
        "within speed_band of the edge before");
  visit("speed_band",
        o.segment.speed_band,
        "speed threshold of speed_rule [m/s]; none: the mean speed",
        GreaterThan{0.0});
  visit("kappa",
        o.segment.kappa,
        "measure of turning: per keyframe [rad], curvature [1/m] or rate [rad/s]");
  visit("kappa_plane",
        o.segment.plane,
        "path used for kappa: in space (3d) or projected along the up axis (xy)");
  visit("turn_max",
        o.segment.turn_max,
        "maximum kappa within a segment [unit of kappa]",
        GreaterThan{0.0});
  visit(
      "short_policy",
      o.short_policy,
      "segments with fewer than min_nodes nodes; borrow_neighbours: their windows include nodes of "
      "neighbours; polyline: straight lines");
  visit("min_nodes",
        o.min_nodes,
        "minimum number of nodes of a full segment; 0: N, or M if N is 0",
        ZeroOr{2, 100});
  visit(
      "scheme",
      o.scheme,
      "windows of a segment; consecutive: adjacent ones share their end nodes; sliding_blend: one "
      "per edge, blended; one_per_segment: nodes subsampled from the segment; first_n: its first "
      "nodes only");
  visit("psi",
        o.psi,
        "use of the optimal tangent: none, or at segment ends (the curve is then C1 there)");
  visit("psi_mean",
        o.psi_mean,
        "optimal tangent: best candidate (discrete) or mean direction on the sphere (frechet)");
  visit("abscissa", o.abscissa, "curve that provides the x' at which y' is evaluated");
  visit("spline_order",
        o.spline_order,
        "order k of the spline through the nodes; 4: natural cubic",
        Between{2, 6});
  visit("frame", o.frame, "axes of a window");
  visit("up",
        o.up,
        "z' axis of the fitting frames: axis of least variance (pca) or z axis of the world");
  visit("guard", o.guard, "split windows whose nodes are not a graph y' = f(x')");
  visit(
      "families",
      o.families,
      "curve families in order of preference, separated by spaces or commas; by_n (parabola for 3 "
      "nodes, cubic for more), line, poly2, poly3, sin1, rat02, hyperbola, implicit");
  visit("selection",
        o.selection,
        "choice of the family: the first that fits (fixed), or the best by loocv");
  visit("fallback",
        o.fallback,
        "curve for nodes that are not a graph: parabola in arc length, or the spline");
  visit("height_guard",
        o.height_guard,
        "reject a surface that leaves the spline by more than the height range of its nodes");
  visit("quadric_cut",
        o.quadric_cut,
        "relative singular value below which directions of a quadric are dropped [-]",
        Between{0.0, 1.0});
  visit(
      "joint",
      o.joint.kind,
      "joint of neighbouring pieces; overlap_blend: blended, C2; quintic_bridge: a quintic through "
      "the node, C2; c0: shifted by half of the jump; none: not joined");
  visit("low_speed_c0_below",
        o.joint.c0_below,
        "speed below which pieces are joined in position only [m/s]; none: never",
        GreaterThan{0.0});
}

class Dm final : public Smoother {
 public:
  using Options = DmOptions;

  /// Throws OptionError for contradictory options or an unknown family.
  explicit Dm(const Options& options);

  /// Smooths the keyframes. O(keyframes log frames). Counts: nodes, quasi_keyframes, gaps_left,
  /// segments and, if the stage is enabled, windows, split_windows, fallbacks, refused_families,
  /// mean_window_nodes, spatial_windows, spatial_truncated, spatial_fallbacks; and the largest
  /// jumps at nodes. Fewer than three nodes give the polyline. Segments separated
  /// by intervals above `chord_above`, or short ones (pose_runs.hpp), are smoothed separately and
  /// joined by chords (smooth_segments()).
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

  /// Returns the same curve as pieces, or null for fewer than three nodes, in the axes of `problem`
  /// for any `fit_axes` and `plane`. `piece_cost`, if set, selects the family instead of
  /// `selection`.
  std::unique_ptr<const manifold::ManifoldCurve> fit(const Problem& problem,
                                                     Report& report,
                                                     const manifold::PieceCost& piece_cost) const;

 private:
  std::unique_ptr<const Curve> smooth_in_axes(const Problem& problem, Report& report) const;
  std::unique_ptr<const manifold::ManifoldCurve> fit(const manifold::NodesWithQuasiKeyframes& dense,
                                                     Report& report,
                                                     const manifold::PieceCost& piece_cost) const;

  Options options_;
  std::vector<manifold::Family> families_;
};

}  // namespace loopbench::methods
