#include "methods/smoothers/manifold/regression.hpp"

namespace loopbench::manifold {

std::optional<PlanarFit> fit_regression(const Nodes& nodes,
                                        std::span<const NodeRange> segments,
                                        const NodeSpline& spline,
                                        std::size_t N) {
  std::vector<double> ways;
  std::vector<BSpline::Value> values;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    ways.push_back(spline.way(i));
    values.emplace_back();
    values.back() << nodes.points[i], 0.0;
  }
  if (!(ways.back() > ways.front())) return std::nullopt;
  std::vector<double> knots;
  for (const NodeRange& segment : segments) {
    for (const Window& window : windows(segment, N, nodes.size())) {
      const double way = ways[window.owned.last];
      const double before = knots.empty() ? ways.front() : knots.back();
      if (way > before && way < ways.back()) knots.push_back(way);
    }
  }
  PlanarFit out;
  const NodeRange all{0, nodes.size() - 1};
  out.keep({all, all},
           AsRegression{std::make_shared<const BSpline>(BSpline::near(ways, values, knots, 4))});
  return out;
}

}  // namespace loopbench::manifold
