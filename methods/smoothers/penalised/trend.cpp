#include "methods/smoothers/penalised/trend.hpp"

#include "datasets/core/banded.hpp"

namespace loopbench::methods {
namespace {

std::vector<double> to_mean_intervals(std::vector<double> stamps, double interval) {
  const double first = stamps.front();
  for (double& stamp : stamps) stamp = (stamp - first) / interval;
  return stamps;
}

}  // namespace

Trend::Trend(const std::vector<double>& stamps)
    : interval_((stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1)),
      slope_change_({0.0, 1.0, 2.0}) {
  times_ = to_mean_intervals(stamps, interval_);
  slope_change_ = SlopeChange(times_);
}

double Trend::min_lambda_of_line(const std::vector<Vector3>& y) const {
  std::vector<Vector3> dual = slope_change_.of(y);
  PentadiagonalFactor(slope_change_.outer()).solve(dual);
  double out = 0.0;
  for (const Vector3& value : dual) out = std::max(out, value.norm());
  return out;
}

Trend::Fit Trend::fit(const std::vector<Vector3>& y, double lambda, double tolerance) const {
  const TrendDual dual =
      solve_trend_dual(slope_change_.outer(), slope_change_.of(y), lambda, tolerance);
  Fit out{y, {}, dual.iterations, dual.converged};
  slope_change_.add_transposed(dual.forces, -1.0, out.values);
  for (const std::size_t row : dual.bends) out.kinks.push_back(row + 1);
  return out;
}

std::vector<Vector3> Trend::refitted(const std::vector<Vector3>& y,
                                     const std::vector<std::size_t>& kinks) const {
  std::vector<std::size_t> knots{0};
  knots.insert(knots.end(), kinks.begin(), kinks.end());
  knots.push_back(y.size() - 1);
  BandedSystem<double, Vector3> system(knots.size(), 1);
  const auto share = [&](std::size_t piece, std::size_t i) {
    return (times_[i] - times_[knots[piece]]) / (times_[knots[piece + 1]] - times_[knots[piece]]);
  };
  const auto for_each_point = [&](auto visit) {
    for (std::size_t piece = 0; piece + 1 < knots.size(); ++piece) {
      const bool last = piece + 2 == knots.size();
      for (std::size_t i = knots[piece]; i < knots[piece + 1] + (last ? 1 : 0); ++i) {
        visit(piece, i, share(piece, i));
      }
    }
  };
  for_each_point([&](std::size_t piece, std::size_t i, double u) {
    const Vector3 value = y[i] - y.front();
    const double v = 1.0 - u;
    system.at(piece, piece) += v * v;
    system.at(piece, piece + 1) += v * u;
    system.right(piece) += v * value;
    system.at(piece + 1, piece + 1) += u * u;
    system.at(piece + 1, piece) += v * u;
    system.right(piece + 1) += u * value;
  });
  const std::vector<Vector3> knot_values = system.solve();
  std::vector<Vector3> out(y.size());
  for_each_point([&](std::size_t piece, std::size_t i, double u) {
    out[i] = y.front() + (1.0 - u) * knot_values[piece] + u * knot_values[piece + 1];
  });
  return out;
}

void Trend::refit(const std::vector<Vector3>& y, Fit& fit) const {
  fit.values = refitted(y, fit.kinks);
  const std::vector<Vector3> slope_changes = slope_change_.of(fit.values);
  double largest = 0.0;
  for (const Vector3& slope_change : slope_changes)
    largest = std::max(largest, slope_change.norm());
  std::erase_if(fit.kinks, [&](std::size_t kink) {
    return slope_changes[kink - 1].norm() <= 1e-9 * largest;  // zero up to rounding
  });
}

}  // namespace loopbench::methods
