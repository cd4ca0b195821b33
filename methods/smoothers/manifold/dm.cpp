#include "methods/smoothers/manifold/dm.hpp"

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/manifold/curve.hpp"

namespace loopbench {

using namespace manifold;  // NOLINT: the steps below are this file's vocabulary

namespace {

double mean_nodes(const std::vector<Window>& windows) {
  double sum = 0.0;
  for (const Window& window : windows) sum += static_cast<double>(window.fitted.nodes());
  return sum / static_cast<double>(windows.size());
}

void count(Report& report, const char* name, std::size_t value) {
  report.count(name, static_cast<double>(value));
}

void describe(const Densified& dense, Report& report) {
  count(report, "nodes", dense.nodes.size());
  count(report, "quasi_keyframes", dense.inserted);
  count(report, "gaps_left", dense.gaps_left);
  if (dense.gaps_left > 0) report.notes.push_back("some gaps hold no tracked frame: left open");
}

void describe(const PlanarFit& fit, Report& report) {
  count(report, "windows", fit.windows.size());
  report.count("mean_window_nodes", mean_nodes(fit.windows));
  count(report, "split_windows", fit.split);
  count(report, "fallbacks", fit.fallbacks);
}

void describe(const SpatialFit& fit, Report& report) {
  count(report, "spatial_windows", fit.windows.size());
  count(report, "spatial_truncated", fit.truncated);
  count(report, "spatial_fallbacks", fit.fallbacks);
}

}  // namespace

std::optional<std::string> Dm::declines(const Problem& problem) const {
  if (problem.keyframes.empty()) return "no keyframes";
  return std::nullopt;
}

std::unique_ptr<const Curve> Dm::smooth(const Problem& problem, Report& report) const {
  Densified dense = with_quasi_keyframes(problem, options_.gap);
  describe(dense, report);
  if (dense.nodes.size() < 3) {
    count(report, "fallbacks", 1);
    report.notes.push_back("fewer than three nodes: polyline");
    return std::make_unique<Polyline>(std::move(dense.nodes));
  }
  const Nodes nodes(dense.nodes);
  const std::vector<NodeRange> runs = segments(nodes, options_.segment);
  count(report, "segments", runs.size());

  Parts parts{nodes.base, up_axis(dense.nodes, options_.up), NodeSpline(nodes), {}, {}};
  if (options_.planar > 0) {
    const auto N = static_cast<std::size_t>(options_.planar);
    PlanarFit fit = fit_planar(nodes, runs, parts.spline, parts.up, N, options_.fallback);
    describe(fit, report);
    parts.planar = joined(nodes, fit.windows, std::move(fit.pieces));
  }
  if (options_.spatial > 0) {
    const auto M = static_cast<std::size_t>(options_.spatial);
    SpatialFit fit = fit_spatial(nodes, runs, parts.spline, parts.up, M, options_.height_guard);
    describe(fit, report);
    parts.spatial = joined(nodes, fit.windows, std::move(fit.pieces));
  }
  return std::make_unique<ManifoldCurve>(dense.nodes, std::move(parts));
}

}  // namespace loopbench
