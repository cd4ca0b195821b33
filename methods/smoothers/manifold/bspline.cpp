#include "methods/smoothers/manifold/bspline.hpp"

#include <algorithm>

#include "datasets/core/banded.hpp"

namespace loopbench::methods::manifold {

using Value = BSpline::Value;

BSpline BSpline::through(std::span<const double> sites,
                         std::span<const Value> values,
                         std::size_t order) {
  const std::size_t count = sites.size();
  BSpline out;
  out.order_ = std::min({order, count, kMaxOrder});
  const std::size_t k = out.order_;
  out.knots_.assign(k, sites.front());
  for (std::size_t j = 1; j + k <= count; ++j) {
    double sum = 0.0;
    for (std::size_t i = j; i < j + k - 1; ++i) sum += sites[i] - sites.front();
    out.knots_.push_back(sites.front() + sum / static_cast<double>(k - 1));
  }
  out.knots_.insert(out.knots_.end(), k, sites.back());

  BandedSystem<double, Value> system(count, k - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t span = out.span(sites[i]);
    const auto N = basis(out.knots_, k, span, sites[i]);
    // At a site on a knot the last or first function is zero and may lie outside the band.
    for (std::size_t j = 0; j < k; ++j) {
      if (N[j] != 0.0) system.at(i, span + 1 - k + j) = N[j];
    }
    system.right(i) = values[i];
  }
  out.controls_ = system.solve();
  return out;
}

BSpline BSpline::near(std::span<const double> sites,
                      std::span<const Value> values,
                      std::span<const double> inner_knots,
                      std::size_t order) {
  constexpr double penalty = 1e-9;
  BSpline out;
  const std::size_t k = order;
  out.order_ = k;
  out.knots_.assign(k, sites.front());
  out.knots_.insert(out.knots_.end(), inner_knots.begin(), inner_knots.end());
  out.knots_.insert(out.knots_.end(), k, sites.back());

  BandedSystem<double, Value> normal(inner_knots.size() + k, k - 1);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t span = out.span(sites[i]);
    const auto N = basis(out.knots_, k, span, sites[i]);
    for (std::size_t a = 0; a < k; ++a) {
      const std::size_t row = span + 1 - k + a;
      for (std::size_t b = 0; b < k; ++b) normal.at(row, span + 1 - k + b) += N[a] * N[b];
      normal.right(row) += N[a] * values[i];
    }
  }
  // Differences over the Greville abscissae, where the controls of a straight line lie, so that a
  // straight line has no penalty.
  std::vector<double> greville(normal.size(), 0.0);
  for (std::size_t j = 0; j < greville.size(); ++j) {
    for (std::size_t i = 1; i < k; ++i)
      greville[j] += out.knots_[j + i] / static_cast<double>(k - 1);
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
  out.controls_ = normal.solve();
  return out;
}

std::size_t BSpline::span(double u) const {
  const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(order_);
  const auto end = knots_.end() - static_cast<std::ptrdiff_t>(order_);
  return static_cast<std::size_t>(std::upper_bound(begin, end, u) - knots_.begin()) - 1;
}

Value BSpline::at(double u) const {
  const std::size_t last = span(u);
  const auto N = basis(knots_, order_, last, u);
  Value out = Value::Zero();
  for (std::size_t j = 0; j < order_; ++j) out += N[j] * controls_[last + 1 - order_ + j];
  return out;
}

Jet<Value> BSpline::at(const Jet<double>& u) const {
  const std::size_t last = span(u.value);
  const auto N = basis(knots_, order_, last, u);
  Jet<Value> out{Value::Zero(), Value::Zero(), Value::Zero()};
  for (std::size_t j = 0; j < order_; ++j) out = out + N[j] * controls_[last + 1 - order_ + j];
  return out;
}

}  // namespace loopbench::methods::manifold
