#include "methods/smoothers/manifold/dm.hpp"

#include <algorithm>
#include <span>

#include "datasets/core/median_interval.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"

namespace loopbench::methods {

using namespace manifold;  // NOLINT: most names in this file are from manifold

namespace {

double mean_nodes(const std::vector<Window>& windows) {
  double sum = 0.0;
  for (const Window& window : windows) sum += static_cast<double>(window.fitted.nodes());
  return sum / static_cast<double>(windows.size());
}

void add_section(
    const char* kind, const Nodes& nodes, NodeRange range, const char* what, Report& report) {
  report.sections.push_back({kind, nodes.stamps[range.first], nodes.stamps[range.last], what});
}

const char* family_name(const GraphPiece<Polynomial>& piece) {
  const auto& c = piece.curve.coefficients;
  if (c[3] != 0.0) return "cubic";
  return c[2] != 0.0 ? "parabola" : "line";
}
const char* family_name(const GraphPiece<Sine>&) { return "sin1"; }
const char* family_name(const GraphPiece<Rational>&) { return "rat02"; }
const char* family_name(const GraphPiece<Hyperbola>&) { return "hyperbola"; }
const char* family_name(const ImplicitPiece&) { return "implicit"; }
const char* family_name(const ArcPiece&) { return "arc"; }
const char* family_name(const ChordPiece&) { return "chord"; }
const char* family_name(const SplinePiece&) { return "spline"; }

/// The functions below add counts, and sections: the segments, the planar windows with their
/// families, the spatial windows.
void count(Report& report, const char* name, std::size_t value) {
  report.count(name, static_cast<double>(value));
}

void describe(const NodesWithQuasiKeyframes& dense, Report& report) {
  count(report, "nodes", dense.nodes.size());
  count(report, "quasi_keyframes", dense.inserted);
  count(report, "gaps_left", dense.gaps_left);
  if (dense.gaps_left > 0)
    report.notes.push_back("no tracked frame to insert in " + std::to_string(dense.gaps_left) +
                           " gaps between keyframes");
}

void describe(const Nodes& nodes, std::span<const NodeRange> segments, Report& report) {
  count(report, "segments", segments.size());
  for (const NodeRange& segment : segments) add_section("segment", nodes, segment, "", report);
}

void describe(const Nodes& nodes, const PlanarFit& fit, Report& report) {
  count(report, "windows", fit.windows.size());
  report.count("mean_window_nodes", mean_nodes(fit.windows));
  count(report, "split_windows", fit.split);
  count(report, "fallbacks", fit.fallbacks);
  count(report, "refused_families", fit.refused);
  if (fit.chords > 0) count(report, "short_chords", fit.chords);
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    const char* family =
        std::visit([](const auto& piece) { return family_name(piece); }, fit.pieces[k]);
    add_section("window", nodes, fit.windows[k].owned, family, report);
  }
}

void describe(const Nodes& nodes, const SpatialFit& fit, Report& report) {
  count(report, "spatial_windows", fit.windows.size());
  count(report, "spatial_truncated", fit.truncated);
  count(report, "spatial_fallbacks", fit.fallbacks);
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    const char* what = fit.pieces[k].surface ? "quadric" : "own height";
    add_section("spatial window", nodes, fit.windows[k].owned, what, report);
  }
}

/// Adds the largest jumps of position, velocity, acceleration, tangent and curvature over all inner
/// nodes. Nodes where the speed on either side is below 1/1000 of the mean speed are ignored for
/// tangent and curvature, because the direction is undefined there. A B-spline of order 3 has its
/// acceleration jumps between nodes. O(nodes).
void describe_jumps(const ManifoldCurve& curve, Report& report) {
  constexpr double min_speed_ratio = 1e-3;  // [of the mean speed]
  const std::vector<double>& stamps = curve.knots();
  double length = 0.0;
  Vector3 last = curve.motion(0, stamps.front()).value;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const Vector3 current = curve.motion(i - 1, stamps[i]).value;
    length += (current - last).norm();
    last = current;
  }
  const double slowest = min_speed_ratio * length / (stamps.back() - stamps.front());
  double position = 0.0, velocity = 0.0, acceleration = 0.0, slope = 0.0, curvature = 0.0;
  for (std::size_t i = 1; i + 1 < stamps.size(); ++i) {
    const MotionJet a = curve.motion(i - 1, stamps[i]);
    const MotionJet b = curve.motion(i, stamps[i]);
    position = std::max(position, (b.value - a.value).norm());
    velocity = std::max(velocity, (b.first - a.first).norm());
    acceleration = std::max(acceleration, (b.second - a.second).norm());
    if (!(a.first.norm() > slowest) || !(b.first.norm() > slowest)) continue;
    slope = std::max(slope, angle_between_directions(a.first, b.first));
    const Vector3 curvature_jump =
        curvature_vector(b.first, b.second) - curvature_vector(a.first, a.second);
    curvature = std::max(curvature, curvature_jump.norm());
  }
  report.count("jump_position", position);          // C0 [m]
  report.count("jump_velocity", velocity);          // C1 [m/s]
  report.count("jump_acceleration", acceleration);  // C2 [m/s^2]
  report.count("jump_slope", slope);                // G1: angle between the tangents [rad]
  report.count("jump_curvature", curvature);        // G2: between the curvature vectors [1/m]
}

std::size_t min_segment_nodes(const DmOptions& o) {
  const int window = o.planar > 0 ? o.planar : o.spatial;
  return static_cast<std::size_t>(o.min_nodes > 0 ? o.min_nodes : window);
}

PlanarRule planar_rule(const DmOptions& o,
                       std::vector<Family> families,
                       const PieceCost& piece_cost) {
  return {.size = static_cast<std::size_t>(o.planar),
          .axes = o.frame,
          .guarded = o.guard,
          .scheme = o.scheme,
          .families = std::move(families),
          .selection = o.selection,
          .piece_cost = piece_cost,
          .fallback = o.fallback,
          .chords_below = o.short_policy == ShortPolicy::polyline ? min_segment_nodes(o) : 0};
}

SpatialRule spatial_rule(const DmOptions& o) {
  return {.size = static_cast<std::size_t>(o.spatial),
          .axes = o.frame,
          .guarded = o.height_guard,
          .scheme = o.scheme,
          .cut = o.quadric_cut,
          .plain_below = o.short_policy == ShortPolicy::polyline ? min_segment_nodes(o) : 0};
}

NodeSpline spline_of(const Nodes& nodes, std::span<const NodeRange> runs, const DmOptions& o) {
  if (o.abscissa == Abscissa::polyline || o.spline_order == 2) return NodeSpline::polyline(nodes);
  if (o.spline_order != 4) {
    return NodeSpline::of_order(nodes, static_cast<std::size_t>(o.spline_order));
  }
  NodeSpline natural(nodes);
  if (o.psi == PsiUse::none) return natural;
  constexpr std::size_t kHalfWindow = 2;  // [steps] on each side that determine psi
  return NodeSpline(nodes, segment_end_velocities(nodes, natural, runs, kHalfWindow, o.psi_mean));
}

Vector3 up_of(const Trajectory& nodes, const DmOptions& o) {
  return up_axis(nodes, o.frame == Axes::world ? UpDirection::world_z : o.up);
}

}  // namespace

Dm::Dm(const Options& options) : options_(options), families_(read_families(options.families)) {
  const auto reject = [](const char* name, const char* why) {
    throw OptionError(name, std::string(name) + ": " + why);
  };
  if (options.plane != Plane::xoy && options.frame != Axes::world) {
    reject("plane", "yoz and xoz require frame = world, because other frames have no such planes");
  }
  if (options.psi != PsiUse::none &&
      (options.abscissa != Abscissa::spline || options.spline_order != 4)) {
    reject("psi", "boundary_tangent requires abscissa = spline and spline_order = 4");
  }
}

std::unique_ptr<const Curve> Dm::smooth(const Problem& problem, Report& report) const {
  const bool is_level = options_.fit_axes == FitAxes::gravity;
  if (!is_level && options_.plane == Plane::xoy) return smooth_in_axes(problem, report);
  Rotation axes = plane_axes(options_.plane);
  if (is_level) axes = axes * level_axes(problem.keyframes);
  return in_world(smooth_in_axes(in_axes(problem, axes), report), problem, axes);
}

std::unique_ptr<const Curve> Dm::smooth_in_axes(const Problem& problem, Report& report) const {
  NodesWithQuasiKeyframes dense = with_quasi_keyframes(problem, options_.gap);
  const auto smooth_nodes = [&](NodesWithQuasiKeyframes nodes,
                                Report& to) -> std::unique_ptr<const Curve> {
    if (nodes.nodes.size() >= 3) return fit(nodes, to, {});
    describe(nodes, to);
    count(to, "fallbacks", 1);
    to.notes.push_back("fewer than three nodes: polyline used");
    return std::make_unique<Polyline>(std::move(nodes.nodes));
  };
  if (dense.nodes.size() < 2 || !options_.chord_above)
    return smooth_nodes(std::move(dense), report);
  const double median = median_interval(problem.keyframes);
  const auto separate = runs_without_breaks(dense.nodes.size(), [&](std::size_t i) {
    const double interval = dense.nodes[i + 1].stamp - dense.nodes[i].stamp;
    return interval > *options_.chord_above * median || interval < kShortestInterval * median;
  });
  if (separate.size() == 1) return smooth_nodes(std::move(dense), report);
  return smooth_segments(dense.nodes,
                         separate,
                         "intervals above chord_above without a tracked frame, or below 0.01 times "
                         "the median",
                         report,
                         [&](Trajectory part, Report& part_report) {
                           return smooth_nodes({std::move(part)}, part_report);
                         });
}

std::unique_ptr<const ManifoldCurve> Dm::fit(const Problem& problem,
                                             Report& report,
                                             const PieceCost& piece_cost) const {
  const NodesWithQuasiKeyframes dense = with_quasi_keyframes(problem, options_.gap);
  if (dense.nodes.size() < 3) return nullptr;
  return fit(dense, report, piece_cost);
}

std::unique_ptr<const ManifoldCurve> Dm::fit(const NodesWithQuasiKeyframes& dense,
                                             Report& report,
                                             const PieceCost& piece_cost) const {
  const Nodes nodes(dense.nodes);
  const Vector3 up = up_of(dense.nodes, options_);
  const SegmentRule& rule = options_.segment;
  const std::vector<NodeRange> runs =
      segments(nodes, rule, kappas(nodes, rule.kappa, rule.plane, up));
  describe(dense, report);
  describe(nodes, runs, report);

  Parts parts{nodes.base, up, spline_of(nodes, runs, options_), {}, {}};
  JoinOptions join{options_.joint, options_.scheme, static_cast<std::size_t>(options_.planar)};
  if (options_.planar > 0) {
    PlanarFit fit =
        fit_planar(nodes, runs, parts.spline, up, planar_rule(options_, families_, piece_cost));
    describe(nodes, fit, report);
    parts.planar = join_pieces<Vector3>(
        nodes,
        fit.windows,
        std::move(fit.pieces),
        join,
        [&](const PlanarPiece& piece, std::size_t edge, const Jet<double>& time) {
          return value_of_piece(piece, parts.spline.at(edge, time));
        });
  }
  if (options_.spatial > 0) {
    join.size = static_cast<std::size_t>(options_.spatial);
    SpatialFit fit = fit_spatial(nodes, runs, parts.spline, up, spatial_rule(options_));
    describe(nodes, fit, report);
    parts.spatial =
        join_pieces<double>(nodes,
                            fit.windows,
                            std::move(fit.pieces),
                            join,
                            [&](const Height& piece, std::size_t edge, const Jet<double>& time) {
                              const MotionJet point = parts.planar_point(edge, time);
                              return piece.over<Jet<double>>(point, along(up, point));
                            });
  }
  auto curve = std::make_unique<ManifoldCurve>(dense.nodes, std::move(parts));
  describe_jumps(*curve, report);
  return curve;
}

}  // namespace loopbench::methods
