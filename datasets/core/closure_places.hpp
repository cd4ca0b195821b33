/// Groups of loop closures between the same two stretches of a chain.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Returns the closures of each place, places in the order of their first closure. Two closures
/// belong to one place if both their ends are at most `reach` keyframes apart, directly or through
/// others. O(closures^2).
inline std::vector<std::vector<std::size_t>> closure_places(const std::vector<Edge>& closures,
                                                            std::size_t reach = 20) {
  const auto apart = [](std::size_t a, std::size_t b) { return a < b ? b - a : a - b; };
  std::vector<std::size_t> place(closures.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  for (std::size_t k = 0; k < closures.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      if (place[l] == place[k] || apart(closures[k].from, closures[l].from) > reach ||
          apart(closures[k].to, closures[l].to) > reach) {
        continue;
      }
      const auto [low, high] = std::minmax({place[k], place[l]});
      std::replace(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(k) + 1, high, low);
    }
  }
  std::vector<std::vector<std::size_t>> by_first(closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) by_first[place[k]].push_back(k);
  std::erase_if(by_first, [](const auto& members) { return members.empty(); });
  return by_first;
}

/// Returns the share of the distance travelled inside loops of two or more places. O(keyframes +
/// closures log closures).
inline double covered_share(const Problem& problem,
                            const std::vector<std::vector<std::size_t>>& places) {
  std::vector<int> change(problem.keyframes.size() + 1, 0);  // of the number of places
  for (const std::vector<std::size_t>& place : places) {
    std::vector<std::pair<std::size_t, std::size_t>> loops;
    for (const std::size_t k : place) {
      loops.emplace_back(problem.closures[k].from, problem.closures[k].to);
    }
    std::ranges::sort(loops);
    std::size_t end = 0;
    for (const auto& [from, to] : loops) {
      if (to <= end) continue;
      ++change[std::max(from, end)];
      --change[to];
      end = to;
    }
  }
  double all = 0.0, covered = 0.0;
  int count = 0;
  auto edge = problem.odometry.begin();
  for (std::size_t k = 0; edge != problem.odometry.end(); ++k) {
    count += change[k];
    if (edge->from != k) continue;  // no odometry from here
    const double length = (edge++)->from_from_to.translation.norm();
    all += length;
    if (count >= 2) covered += length;
  }
  return all > 0.0 ? covered / all : 0.0;
}

/// Returns the problem without these closures (indices, ascending). O(closures).
inline Problem without_closures(Problem problem, const std::vector<std::size_t>& closures) {
  for (auto k = closures.rbegin(); k != closures.rend(); ++k) {
    problem.closures.erase(problem.closures.begin() + static_cast<std::ptrdiff_t>(*k));
  }
  return problem;
}

/// How well the closures of each place are predicted without them.
struct PlacePrediction {
  double ratio = 1.0;      ///< geometric mean over places of predicted over uncorrected error [-]
  std::size_t better = 0;  ///< places whose predicted error is the smaller one
};

/// The error of a place is the root mean square over its closures; `predicted` and `uncorrected`
/// return the error of a closure [m]. O(closures).
template <class Predicted, class Uncorrected>
PlacePrediction place_prediction(const std::vector<std::vector<std::size_t>>& places,
                                 Predicted predicted,
                                 Uncorrected uncorrected) {
  constexpr double kExact = 1e-18;  // squared error that is rounding [m^2]
  PlacePrediction out;
  double sum = 0.0;
  for (const std::vector<std::size_t>& place : places) {
    double with_others = 0.0, without = 0.0;
    for (const std::size_t k : place) {
      with_others += std::pow(predicted(k), 2);
      without += std::pow(uncorrected(k), 2);
    }
    sum += 0.5 * std::log(std::max(with_others, kExact) / std::max(without, kExact));
    if (with_others < without) ++out.better;
  }
  if (!places.empty()) out.ratio = std::exp(sum / static_cast<double>(places.size()));
  return out;
}

}  // namespace loopbench
