/// B-spline basis of order k on knots that are repeated k times at both ends.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace loopbench::methods {

/// m + 1 breaks have m - 1 + k functions. On piece p, breaks[p]..breaks[p + 1], only
/// N_p..N_{p+k-1} are nonzero. Order k is degree k - 1. The functions follow the article's equation
/// (12), corrected: its second numerator is printed as m_{t+k}; it must be m_{t+k} - u, otherwise
/// they do not sum to 1.
class SplineBasis {
 public:
  static constexpr std::size_t kMaxOrder = 6;
  using Values = std::array<double, kMaxOrder>;

  /// Requires at least two strictly increasing breaks and an order in 2..6.
  SplineBasis(std::size_t order, std::vector<double> breaks)
      : order_(order), breaks_(std::move(breaks)), knots_(order, breaks_.front()) {
    knots_.insert(knots_.end(), breaks_.begin() + 1, breaks_.end() - 1);
    knots_.insert(knots_.end(), order, breaks_.back());
  }

  /// Returns a basis with as many functions as sites. Inner knots are means of k - 1 neighbouring
  /// sites, so the Schoenberg-Whitney conditions hold (de Boor ch. XIII). Requires at least two
  /// sites; the order is reduced to their number.
  static SplineBasis for_sites(std::size_t order, const std::vector<double>& sites) {
    const std::size_t k = std::min(order, sites.size());
    std::vector<double> breaks{sites.front()};
    for (std::size_t j = 1; j + k <= sites.size(); ++j) {
      double sum = 0.0;
      for (std::size_t i = j; i < j + k - 1; ++i) sum += sites[i] - sites.front();
      breaks.push_back(sites.front() + sum / static_cast<double>(k - 1));
    }
    breaks.push_back(sites.back());
    return {k, std::move(breaks)};
  }

  std::size_t order() const { return order_; }
  std::size_t size() const { return breaks_.size() - 2 + order_; }
  const std::vector<double>& breaks() const { return breaks_; }

  /// Returns the piece that contains the time; outside, the first or last one. O(log pieces).
  std::size_t piece_at(double time) const {
    const auto after = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, time);
    return static_cast<std::size_t>(after - breaks_.begin()) - 1;
  }

  /// Returns N_p..N_{p+k-1} at a time, a double or a Jet, in piece p: all >= 0, sum 1. By the
  /// recursion from order 1, O(k^2).
  template <class T>
  std::array<T, kMaxOrder> values(std::size_t piece, const T& time) const {
    const std::size_t span = piece + order_ - 1;
    std::array<T, kMaxOrder> out{};
    out[0] = 0.0 * time + 1.0;
    for (std::size_t order = 2; order <= order_; ++order) {
      T carried = 0.0 * time;
      for (std::size_t r = 0; r + 1 < order; ++r) {
        const double right = knots_[span + 1 + r];
        const double left = knots_[span + 2 + r - order];
        const T part = (1.0 / (right - left)) * out[r];
        out[r] = carried + (right - time) * part;
        carried = (time - left) * part;
      }
      out[order - 1] = carried;
    }
    return out;
  }

  /// Returns N_p + .. + N_{p+k-1}, N_{p+1} + .., .., N_{p+k-1}, the cumulative basis. O(k^2).
  Values cumulative(std::size_t piece, double time) const {
    Values out = values(piece, time);
    for (std::size_t j = order_ - 1; j-- > 0;) out[j] += out[j + 1];
    return out;
  }

  /// Greville abscissa of N_j: the time of its coefficient when the curve is a straight line [s].
  double greville(std::size_t j) const {
    double sum = 0.0;
    for (std::size_t i = 1; i < order_; ++i) sum += knots_[j + i] - knots_.front();
    return knots_.front() + sum / static_cast<double>(order_ - 1);
  }

 private:
  std::size_t order_;
  std::vector<double> breaks_;
  std::vector<double> knots_;
};

}  // namespace loopbench::methods
