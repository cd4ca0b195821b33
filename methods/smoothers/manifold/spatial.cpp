#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::manifold {
namespace {

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
                       const Vector3& up,
                       std::size_t M) {
  SpatialFit out;
  for (const NodeRange& segment : segments) {
    for (const Window& window : windows(segment, M, nodes.size())) {
      const auto surface = fit_surface(nodes, window.fitted, up);
      if (!surface) ++out.fallbacks;
      if (surface && surface->quadric.rank < 6) ++out.truncated;
      out.windows.push_back(window);
      out.pieces.push_back({surface});
    }
  }
  return out;
}

}  // namespace loopbench::manifold
