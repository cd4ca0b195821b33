#include "datasets/derive/false_closures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/derive/closures.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench {

std::size_t add_false_closures(Problem& problem,
                               const FalseClosures& options,
                               std::uint64_t noise_identity) {
  constexpr std::size_t kMinDistance = 2;  // [keyframes]; neighbours are connected by odometry
  const std::size_t n = problem.keyframes.size();
  const std::size_t given = problem.closures.size();
  if (given == 0 || options.share == 0.0) return 0;
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
  for (std::size_t added = 0; added < count;) {
    const auto [from, to] = std::minmax({random.index(n), random.index(n)});
    Edge edge = problem.closures[random.index(given)];
    if (to - from < min_distance) continue;
    edge.from = from;
    edge.to = to;
    problem.closures.push_back(edge);
    ++added;
  }
  sort_closures(problem.closures);
  return count;
}

std::string false_closures_text(const FalseClosures& options, std::size_t added, std::size_t all) {
  if (options.share == 0.0) return "";
  return fmt::format(", {} of {} false and added", added, all);
}

}  // namespace loopbench
