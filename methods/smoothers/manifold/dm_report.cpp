#include "methods/smoothers/manifold/dm_report.hpp"

#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"

namespace loopbench::methods::manifold {
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
  return c[3] != 0.0 ? "cubic" : c[2] != 0.0 ? "parabola" : "line";
}
const char* family_name(const GraphPiece<Sine>&) { return "sin1"; }
const char* family_name(const GraphPiece<Rational>&) { return "rat02"; }
const char* family_name(const GraphPiece<Hyperbola>&) { return "hyperbola"; }
const char* family_name(const ImplicitPiece&) { return "implicit"; }
const char* family_name(const ArcPiece&) { return "arc"; }
const char* family_name(const ChordPiece&) { return "chord"; }
const char* family_name(const SplinePiece&) { return "spline"; }

}  // namespace

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
  double position = 0.0, velocity = 0.0, acceleration = 0.0, slope = 0.0, bend = 0.0;
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
    bend = std::max(bend, curvature_jump.norm());
  }
  report.count("jump_position", position);          // C0 [m]
  report.count("jump_velocity", velocity);          // C1 [m/s]
  report.count("jump_acceleration", acceleration);  // C2 [m/s^2]
  report.count("jump_slope", slope);                // G1: angle between the tangents [rad]
  report.count("jump_curvature", bend);             // G2: between the curvature vectors [1/m]
}

}  // namespace loopbench::methods::manifold
