#include "methods/smoothers/manifold/planar.hpp"

#include "methods/smoothers/manifold/window_fit.hpp"

namespace loopbench::methods::manifold {
namespace {

constexpr std::size_t kSmallest = 3;  // [nodes] smaller windows are not split; two nodes are a line
constexpr std::array kPolynomial{Family::by_n};

PlanarPiece fallback_piece(const Nodes& nodes,
                           NodeRange range,
                           const NodeSpline& spline,
                           Fallback fallback) {
  if (fallback == Fallback::spline || range.nodes() != 3) return SplinePiece{};
  const std::size_t i = range.first;
  const std::array points{nodes.points[i], nodes.points[i + 1], nodes.points[i + 2]};
  const std::array arc_lengths{spline.distance(i), spline.distance(i + 1), spline.distance(i + 2)};
  const auto arc = fit_arc(points, arc_lengths);
  return arc ? PlanarPiece(ArcPiece{*arc}) : PlanarPiece(SplinePiece{});
}

void keep_chords(const Nodes& nodes, NodeRange segment, PlanarFit& out) {
  for (std::size_t i = segment.first; i < segment.last; ++i) {
    ++out.chords;
    out.keep(
        {{i, i + 1}, {i, i + 1}},
        ChordPiece{nodes.stamps[i], nodes.stamps[i + 1], nodes.points[i], nodes.points[i + 1]});
  }
}

}  // namespace

PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     const PlanarRule& rule) {
  PlanarFit out;
  // Reserves memory, because reallocation would move every piece.
  const std::size_t steps = rule.scheme == Scheme::sliding_blend ? 1 : rule.size - 1;
  out.windows.reserve(nodes.size() / steps + segments.size());
  out.pieces.reserve(nodes.size() / steps + segments.size());
  const WindowFitter fitter{nodes, spline, up, rule};
  // Fits the families of the rule, or a polynomial if they fail; returns nullopt if the guard
  // rejects the window.
  const auto fit = [&](const Window& window) -> std::optional<PlanarPiece> {
    if (!fitter.admits(window)) return std::nullopt;
    if (auto piece = fitter.fit(window, rule.families)) return piece;
    auto piece = fitter.fit(window, kPolynomial);
    if (piece) ++out.refused;
    return piece;
  };
  const auto fit_small = [&](const Window& window) {
    if (const auto piece = fit(window)) return out.keep(window, *piece);
    ++out.fallbacks;
    out.keep(window, fallback_piece(nodes, window.fitted, spline, rule.fallback));
  };
  for (const NodeRange& segment : segments) {
    if (segment.nodes() < rule.chords_below) {
      keep_chords(nodes, segment, out);
      continue;
    }
    for (const Window& window : windows(segment, rule.size, nodes.size(), rule.scheme)) {
      if (window.fitted.nodes() <= kSmallest || !rule.guarded) {
        fit_small(window);
      } else if (const auto piece = fit(window)) {
        out.keep(window, *piece);
      } else {
        ++out.split;
        for (const Window& part : windows(window.owned, kSmallest, nodes.size())) fit_small(part);
      }
    }
  }
  return out;
}

}  // namespace loopbench::methods::manifold
