#include "harness/plot/wraps.hpp"

#include <cmath>
#include <limits>

namespace loopbench::harness {

void break_at_wraps(PlotPanel& panel) {
  const Vector3 gap = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (PlotSeries& series : panel.series) {
    std::vector<Vector3> points;
    for (const Vector3& p : series.points) {
      if (!points.empty() && std::abs(p.y() - points.back().y()) > 180.0) points.push_back(gap);
      points.push_back(p);
    }
    series.points = std::move(points);
  }
}

}  // namespace loopbench::harness
