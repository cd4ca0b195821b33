#include "methods/correctors/gnc.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::methods {

double gnc_weight(Gnc kind, double squared, double c2, double mu) {
  if (kind == Gnc::gm) {
    const double w = mu * c2 / (squared + mu * c2);
    return w * w;
  }
  if (squared <= mu / (mu + 1.0) * c2) return 1.0;
  if (squared >= (mu + 1.0) / mu * c2) return 0.0;
  return std::sqrt(c2 * mu * (mu + 1.0) / squared) - mu;
}

GncResult graduate_weights(
    Gnc kind,
    double c2,
    std::vector<double> squared,
    std::optional<double> begin,
    const std::function<std::vector<double>(const std::vector<double>&)>& solve) {
  GncResult out;
  out.weights.assign(squared.size(), 1.0);
  const double largest = *std::ranges::max_element(squared);
  if (largest <= c2) return out;
  const bool is_tls = kind == Gnc::tls;
  // Truncated least squares becomes less convex as mu grows, Geman-McClure as mu shrinks to 1.
  double mu = begin.value_or(is_tls ? c2 / (2.0 * largest - c2) : 2.0 * largest / c2);
  constexpr int kMaxRounds = 100;
  for (bool converged = false; !converged && out.rounds < kMaxRounds; ++out.rounds) {
    for (std::size_t k = 0; k < squared.size(); ++k) {
      out.weights[k] = gnc_weight(kind, squared[k], c2, mu);
    }
    squared = solve(out.weights);
    converged =
        is_tls ? std::ranges::all_of(out.weights, [](double w) { return w == 0.0 || w == 1.0; })
               : mu <= 1.0;
    mu = is_tls ? 1.4 * mu : std::max(1.0, mu / 1.4);
  }
  return out;
}

}  // namespace loopbench::methods
