#include "methods/smoothers/penalised/reinsch.hpp"

#include <algorithm>

namespace loopbench::methods {
namespace {

/// Evaluates every `coarse`-th integer from low to high and then every integer around the best of
/// them. Returns the minimiser if the function has a single minimum at least `coarse` wide. A later
/// value must be lower by a relative 1e-9 to win, so that rounding does not change the choice.
template <class Score>
int minimise_on_lattice(int low, int high, int coarse, Score score) {
  int best = low;
  double lowest = score(low);
  const auto evaluate = [&](int k) {
    const double value = score(k);
    if (value < lowest - 1e-9 * std::abs(lowest)) {
      lowest = value;
      best = k;
    }
  };
  for (int k = low + coarse; k <= high; k += coarse) evaluate(k);
  const int middle = best;
  for (int k = std::max(low, middle - coarse + 1); k <= std::min(high, middle + coarse - 1); ++k) {
    if (k != middle) evaluate(k);
  }
  return best;
}

}  // namespace

Reinsch::Reinsch(const std::vector<double>& stamps)
    : slope_change_(stamps), gram_(slope_change_.size()), outer_(slope_change_.outer()) {
  for (std::size_t j = 0; j < gram_.size(); ++j) {
    gram_[j].diagonal = (stamps[j + 2] - stamps[j]) / 3.0;
    if (j + 1 < gram_.size()) gram_[j].next = (stamps[j + 2] - stamps[j + 1]) / 6.0;
  }
}

Reinsch::Fit Reinsch::fit(const std::vector<Vector3>& y, double lambda) const {
  Pentadiagonal matrix = gram_;
  for (std::size_t j = 0; j < matrix.size(); ++j) {
    matrix[j].diagonal += lambda * outer_[j].diagonal;
    matrix[j].next += lambda * outer_[j].next;
    matrix[j].second += lambda * outer_[j].second;
  }
  const PentadiagonalFactor factor(std::move(matrix));
  const std::vector<Vector3> right = slope_change_.of(y);
  std::vector<Vector3> gamma = right;
  factor.solve(gamma);

  Fit out;
  out.energy.setZero();
  for (std::size_t j = 0; j < gamma.size(); ++j) {
    out.energy += lambda * right[j].cwiseProduct(gamma[j]);
  }
  std::vector<Vector3> residuals(y.size(), Vector3::Zero());
  slope_change_.add_transposed(gamma, lambda, residuals);
  out.residual.setZero();
  for (const Vector3& residual : residuals) out.residual += residual.cwiseAbs2();
  out.values = y;
  for (std::size_t i = 0; i < y.size(); ++i) out.values[i] -= residuals[i];
  out.residual_dof = lambda * trace_of_product(outer_, factor.inverse_bands());
  out.log_determinant =
      static_cast<double>(gamma.size()) * std::log(lambda) - factor.log_determinant();
  out.curvatures = std::move(gamma);
  out.curvatures.insert(out.curvatures.begin(), Vector3::Zero());
  out.curvatures.push_back(Vector3::Zero());
  return out;
}

double score(Criterion criterion, const Reinsch::Fit& fit, std::size_t n) {
  const auto size = static_cast<double>(n);
  if (criterion == Criterion::gcv)
    return size * fit.residual.sum() / (fit.residual_dof * fit.residual_dof);
  constexpr double kTiny = 1e-300;  // keeps the logarithm finite for a straight line
  // REML with a variance common to three axes: 3 (n - 2) log(sum) - 3 log det, divided by three.
  return (size - 2.0) * std::log(fit.energy.sum() + kTiny) - fit.log_determinant;
}

namespace {

constexpr int kPerDecade = 8, kSmallestPower = -6 * kPerDecade, kLargestPower = 12 * kPerDecade;

double lambda_at(const std::vector<double>& stamps, int k) {
  const double interval = (stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1);
  return std::pow(interval, 3) * std::pow(10.0, static_cast<double>(k) / kPerDecade);
}

}  // namespace

double interpolating_lambda(const std::vector<double>& stamps) {
  return lambda_at(stamps, kSmallestPower);
}

double select_lambda(const Reinsch& reinsch,
                     const std::vector<double>& stamps,
                     const std::vector<Vector3>& y,
                     Criterion criterion) {
  return lambda_at(stamps,
                   minimise_on_lattice(kSmallestPower, kLargestPower, kPerDecade, [&](int k) {
                     return score(criterion, reinsch.fit(y, lambda_at(stamps, k)), y.size());
                   }));
}

}  // namespace loopbench::methods
