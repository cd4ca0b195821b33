#include "methods/smoothers/manifold/bspline.hpp"

#include "datasets/core/banded.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods::manifold {

using Value = BSpline::Value;

BSpline BSpline::through(const std::vector<double>& sites,
                         const std::vector<Value>& values,
                         std::size_t order) {
  SplineBasis basis = SplineBasis::for_sites(order, sites);
  std::vector<Value> controls = interpolating_controls(basis, sites, values);
  return {std::move(basis), std::move(controls)};
}

BSpline BSpline::near(const std::vector<double>& sites,
                      const std::vector<Value>& values,
                      const std::vector<double>& inner_knots) {
  constexpr double penalty = 1e-9;
  constexpr std::size_t k = 4;
  std::vector<double> breaks{sites.front()};
  breaks.insert(breaks.end(), inner_knots.begin(), inner_knots.end());
  breaks.push_back(sites.back());
  SplineBasis basis(k, std::move(breaks));

  BandedSystem<double, Value> normal(basis.size(), k - 1);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t piece = basis.piece_at(sites[i]);
    const auto N = basis.values(piece, sites[i]);
    for (std::size_t a = 0; a < k; ++a) {
      for (std::size_t b = 0; b < k; ++b) normal.at(piece + a, piece + b) += N[a] * N[b];
      normal.right(piece + a) += N[a] * values[i];
    }
  }
  // Differences over the Greville abscissae, where the controls of a straight line lie, so that a
  // straight line has no penalty.
  std::vector<double> greville(normal.size(), 0.0);
  for (std::size_t j = 0; j < greville.size(); ++j) {
    for (std::size_t i = 1; i < k; ++i)
      greville[j] += basis.knots()[j + i] / static_cast<double>(k - 1);
  }
  for (std::size_t row = 0; row + 2 < normal.size(); ++row) {
    const double before = greville[row + 1] - greville[row];
    const double after = greville[row + 2] - greville[row + 1];
    const double mean = 0.5 * (before + after);
    const std::array difference{mean / before, -mean / before - mean / after, mean / after};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        normal.at(row + a, row + b) += penalty * difference[a] * difference[b];
      }
    }
  }
  std::vector<Value> controls = normal.solve();
  return {std::move(basis), std::move(controls)};
}

Value BSpline::at(double u) const {
  const std::size_t piece = basis.piece_at(u);
  const auto N = basis.values(piece, u);
  Value out = Value::Zero();
  for (std::size_t j = 0; j < basis.order(); ++j) out += N[j] * controls[piece + j];
  return out;
}

Jet<Value> BSpline::at(const Jet<double>& u) const {
  const std::size_t piece = basis.piece_at(u.value);
  const auto N = basis.values(piece, u);
  Jet<Value> out{Value::Zero(), Value::Zero(), Value::Zero()};
  for (std::size_t j = 0; j < basis.order(); ++j) out = out + N[j] * controls[piece + j];
  return out;
}

}  // namespace loopbench::methods::manifold
