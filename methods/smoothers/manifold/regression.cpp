#include "methods/smoothers/manifold/regression.hpp"

namespace loopbench::methods::manifold {

std::optional<PlanarFit> fit_regression(const Nodes& nodes,
                                        std::span<const NodeRange> segments,
                                        const NodeSpline& spline,
                                        std::size_t N) {
  std::vector<double> arc_lengths;
  std::vector<BSpline::Value> values;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    arc_lengths.push_back(spline.distance(i));
    values.emplace_back();
    values.back() << nodes.points[i], 0.0;
  }
  if (!(arc_lengths.back() > arc_lengths.front())) return std::nullopt;
  std::vector<double> knots;
  for (const NodeRange& segment : segments) {
    for (const Window& window : windows(segment, N, nodes.size())) {
      const double arc_length = arc_lengths[window.owned.last];
      const double before = knots.empty() ? arc_lengths.front() : knots.back();
      if (arc_length > before && arc_length < arc_lengths.back()) knots.push_back(arc_length);
    }
  }
  PlanarFit out;
  const NodeRange all{0, nodes.size() - 1};
  out.keep(
      {all, all},
      RegressionPiece{std::make_shared<const BSpline>(BSpline::near(arc_lengths, values, knots))});
  return out;
}

}  // namespace loopbench::methods::manifold
