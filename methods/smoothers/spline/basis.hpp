/// B-splines of order k on knots that are k-fold at both ends.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "methods/smoothers/manifold/bspline.hpp"

namespace loopbench {

/// m + 1 breaks carry m - 1 + k functions; on piece p, breaks[p]..breaks[p + 1], only
/// N_p..N_{p+k-1} differ from zero. Order k is degree k - 1.
class SplineBasis {
 public:
  static constexpr std::size_t kMostOrder = manifold::kMostOrder;
  using Values = std::array<double, kMostOrder>;

  /// `breaks` strictly increase, two or more; order 2..6.
  SplineBasis(std::size_t order, std::vector<double> breaks)
      : order_(order), breaks_(std::move(breaks)), knots_(order, breaks_.front()) {
    knots_.insert(knots_.end(), breaks_.begin() + 1, breaks_.end() - 1);
    knots_.insert(knots_.end(), order, breaks_.back());
  }

  /// As many functions as sites, inner knots in the mean of k - 1 neighbours, which puts a site
  /// under every function (Schoenberg and Whitney; de Boor ch. XIII). Two sites or more; the order
  /// is lowered to their number.
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

  /// N_p..N_{p+k-1} at a time in piece p: all >= 0, sum 1. O(k^2).
  Values values(std::size_t piece, double time) const {
    return manifold::basis(knots_, order_, piece + order_ - 1, time);
  }

  /// N_p + .. + N_{p+k-1}, N_{p+1} + .., .., N_{p+k-1}: what cumulative splines use. O(k^2).
  Values cumulative(std::size_t piece, double time) const {
    Values out = values(piece, time);
    for (std::size_t j = order_ - 1; j-- > 0;) out[j] += out[j + 1];
    return out;
  }

  /// Where the coefficient of N_j sits when the curve is a straight line [s].
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

}  // namespace loopbench
