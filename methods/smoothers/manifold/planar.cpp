#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::manifold {
namespace {

constexpr std::size_t kSmallest = 3;  // [nodes] a window is not split further: two make a line

std::optional<Graph> fit_graph(const Nodes& nodes, NodeRange range, const Vector3& up) {
  const auto frame = chord_frame(nodes, range, up);
  if (!frame) return std::nullopt;
  const std::vector<Vector2> points = local(nodes, range, *frame);
  if (!is_graph(points)) return std::nullopt;
  return Graph{*frame, fit_polynomial(points, points.size() > 3 ? 3 : 2)};
}

PlanarPiece fallen_back(const Nodes& nodes,
                        NodeRange range,
                        const NodeSpline& spline,
                        Fallback fallback) {
  if (fallback == Fallback::spline || range.nodes() != 3) return AsSpline{};
  const std::size_t i = range.first;
  const std::array points{nodes.points[i], nodes.points[i + 1], nodes.points[i + 2]};
  const std::array ways{spline.way(i), spline.way(i + 1), spline.way(i + 2)};
  const auto arc = fit_arc(points, ways);
  return arc ? PlanarPiece(AsArc{*arc}) : PlanarPiece(AsSpline{});
}

}  // namespace

PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     std::size_t N,
                     Fallback fallback) {
  PlanarFit out;
  const auto keep = [&](const Window& window, const PlanarPiece& piece) {
    out.windows.push_back(window);
    out.pieces.push_back(piece);
  };
  const auto fit_small = [&](const Window& window) {
    if (const auto graph = fit_graph(nodes, window.fitted, up)) return keep(window, *graph);
    ++out.fallbacks;
    keep(window, fallen_back(nodes, window.fitted, spline, fallback));
  };
  for (const NodeRange& segment : segments) {
    for (const Window& window : windows(segment, N, nodes.size())) {
      if (window.fitted.nodes() <= kSmallest) {
        fit_small(window);
      } else if (const auto graph = fit_graph(nodes, window.fitted, up)) {
        keep(window, *graph);
      } else {
        ++out.split;
        for (const Window& part : windows(window.owned, kSmallest, nodes.size())) fit_small(part);
      }
    }
  }
  return out;
}

}  // namespace loopbench::manifold
