#include "methods/smoothers/manifold/dm_report.hpp"

#include <algorithm>

#include "methods/smoothers/manifold/coefficients.hpp"

namespace loopbench::methods::manifold {
namespace {

double mean_nodes(const std::vector<Window>& windows) {
  double sum = 0.0;
  for (const Window& window : windows) sum += static_cast<double>(window.fitted.nodes());
  return sum / static_cast<double>(windows.size());
}

std::string nodes_of(const Window& window) {
  return "nodes " + std::to_string(window.fitted.first) + ".." +
         std::to_string(window.fitted.last) + ": ";
}

Section section(const char* kind, const Nodes& nodes, NodeRange range, std::string what) {
  return {kind, nodes.stamps[range.first], nodes.stamps[range.last], std::move(what)};
}

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

void describe(const PlanarFit& fit, Report& report) {
  count(report, "windows", fit.windows.size());
  report.count("mean_window_nodes", mean_nodes(fit.windows));
  count(report, "split_windows", fit.split);
  count(report, "fallbacks", fit.fallbacks);
  count(report, "refused_families", fit.refused);
  if (fit.chords > 0) count(report, "short_chords", fit.chords);
}

void describe(const SpatialFit& fit, Report& report) {
  count(report, "spatial_windows", fit.windows.size());
  count(report, "spatial_truncated", fit.truncated);
  count(report, "spatial_fallbacks", fit.fallbacks);
}

void describe(const Nodes& nodes, std::span<const NodeRange> segments, Report& report) {
  for (const NodeRange& segment : segments) {
    report.sections.push_back(section("segment", nodes, segment, ""));
  }
}

void describe(const Nodes& nodes, const PlanarFit& fit, Report& report) {
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    report.sections.push_back(
        section("window", nodes, fit.windows[k].owned, family_name(fit.pieces[k])));
  }
}

void describe(const Nodes& nodes, const SpatialFit& fit, Report& report) {
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    report.sections.push_back(section("spatial window",
                                      nodes,
                                      fit.windows[k].owned,
                                      fit.pieces[k].surface ? "quadric" : "own height"));
  }
}

void describe(const Continuity& jumps, Report& report) {
  report.count("jump_position", jumps.position);
  report.count("jump_velocity", jumps.velocity);
  report.count("jump_acceleration", jumps.acceleration);
  report.count("jump_slope", jumps.slope);
  report.count("jump_curvature", jumps.curvature);
}

void describe(const CurveFrames& frames, Report& report) {
  report.count("curvature_max",
               *std::max_element(frames.curvature.begin(), frames.curvature.end()));
  report.count("torsion_max", frames.torsion_max);
  count(report, "frenet_undefined", frames.carried);
}

void add_coefficient_notes(const PlanarFit& fit, Report& report) {
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    report.notes.push_back(nodes_of(fit.windows[k]) + description(fit.pieces[k]));
  }
}

void add_coefficient_notes(const SpatialFit& fit, double base_height, Report& report) {
  for (std::size_t k = 0; k < fit.windows.size(); ++k) {
    const auto& surface = fit.pieces[k].surface;
    if (!surface) continue;
    report.notes.push_back(nodes_of(fit.windows[k]) +
                           "quadric: " + text(coefficients(surface->quadric, base_height)));
  }
}

}  // namespace loopbench::methods::manifold
