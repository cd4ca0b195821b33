#include "methods/smoothers/manifold/spatial.hpp"

#include <algorithm>

namespace loopbench::manifold {
namespace {

constexpr double kRounding = 1e-9;  // [of the window] level motion has no range of heights

bool is_tame(const Height::Surface& surface,
             const Nodes& nodes,
             const Window& window,
             const NodeSpline& spline,
             const Vector3& up) {
  double low = up.dot(nodes.points[window.fitted.first]);
  double high = low;
  for (std::size_t i = window.fitted.first; i <= window.fitted.last; ++i) {
    low = std::min(low, up.dot(nodes.points[i]));
    high = std::max(high, up.dot(nodes.points[i]));
  }
  const double most = high - low + kRounding * surface.quadric.scale;
  const std::size_t begin = window.owned.first > 0 ? window.owned.first - 1 : 0;
  const std::size_t end = std::min(window.owned.last + 1, nodes.size() - 1);
  for (std::size_t edge = begin; edge < end; ++edge) {
    for (const double u : {0.25, 0.5, 0.75}) {
      const Vector3 point = spline.at(edge, nodes.stamps[edge] + u * nodes.duration(edge)).point;
      if (std::abs(surface.height(point) - up.dot(point)) > most) return false;
    }
  }
  return true;
}

std::optional<Height::Surface> fit_surface(const Nodes& nodes, NodeRange range, const Vector3& up) {
  const auto frame = chord_frame(nodes, range, up);
  if (!frame) return std::nullopt;
  std::vector<double> heights;
  for (std::size_t i = range.first; i <= range.last; ++i) {
    heights.push_back(up.dot(nodes.points[i]));
  }
  const auto quadric = fit_quadric(local(nodes, range, *frame), heights);
  if (!quadric) return std::nullopt;
  return Height::Surface{*frame, *quadric};
}

}  // namespace

SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const NodeSpline& spline,
                       const Vector3& up,
                       std::size_t M,
                       bool guarded) {
  SpatialFit out;
  for (const NodeRange& segment : segments) {
    for (const Window& window : windows(segment, M, nodes.size())) {
      auto surface = fit_surface(nodes, window.fitted, up);
      if (surface && guarded && !is_tame(*surface, nodes, window, spline, up)) surface.reset();
      if (!surface) ++out.fallbacks;
      if (surface && surface->quadric.rank < 6) ++out.truncated;
      out.windows.push_back(window);
      out.pieces.push_back({surface});
    }
  }
  return out;
}

}  // namespace loopbench::manifold
