/// Simulated false loop closures, which connect unrelated keyframes.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/noise/noise_stream.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench {

struct FalseClosures {
  double share = 0.0;  ///< of false closures among all closures after the addition [-]
  std::int64_t seed = 1;
};

template <class Visit>
void false_closure_fields(FalseClosures& o, Visit visit) {
  visit("false_closures.share",
        o.share,
        "share of simulated false closures among all closures, after their addition [-]",
        Between{0.0, 0.95});
  visit("false_closures.seed", o.seed, "random seed of the false closures", Between{0});
}

/// Adds false closures until their share (rounded to a whole number) is reached. Each connects two
/// random keyframes, at least two keyframes and 1/20 of the chain apart, with the measurement and
/// information of a random closure of the problem. The reference is not used, so a false closure
/// may connect keyframes that are close to each other. Closures remain sorted. Draws are identical
/// with every standard library. Returns their indices, ascending; none for a problem without
/// closures. Throws InputError for fewer than 3 keyframes. O(closures log closures).
inline std::vector<std::size_t> add_false_closures(Problem& problem,
                                                   const FalseClosures& options,
                                                   std::uint64_t noise_identity) {
  constexpr std::size_t kMinDistance = 2;  // [keyframes]; neighbours are connected by odometry
  const std::size_t n = problem.keyframes.size();
  const std::size_t given = problem.closures.size();
  if (given == 0 || options.share == 0.0) return {};
  if (n <= kMinDistance) {
    throw InputError(
        fmt::format("false_closures.share = {}: found {} keyframes, expected at least {}",
                    options.share,
                    n,
                    kMinDistance + 1));
  }
  const auto count = static_cast<std::size_t>(
      std::llround(static_cast<double>(given) * options.share / (1.0 - options.share)));
  Random random({options.seed, noise_identity}, Purpose::false_closures);
  const std::size_t min_distance = std::max(kMinDistance, n / 20);
  std::vector<std::size_t> added;
  while (added.size() < count) {
    const auto [from, to] = std::minmax({random.index(n), random.index(n)});
    Edge edge = problem.closures[random.index(given)];
    if (to - from < min_distance) continue;
    edge.from = from;
    edge.to = to;
    added.push_back(problem.closures.size());
    problem.closures.push_back(edge);
  }
  sort_closures(problem.closures, &added);
  return added;
}

/// Provenance text: ", 5 of 10 false and added"; empty if options.share is 0.
inline std::string false_closures_text(const FalseClosures& options,
                                       std::size_t added,
                                       std::size_t all) {
  if (options.share == 0.0) return "";
  return fmt::format(", {} of {} false and added", added, all);
}

}  // namespace loopbench
