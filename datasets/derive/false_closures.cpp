#include "datasets/derive/false_closures.hpp"

#include <cmath>

#include "datasets/derive/closures.hpp"
#include "datasets/random.hpp"

namespace loopbench {

std::size_t add_false_closures(Problem& problem, const FalseClosures& options) {
  const std::size_t n = problem.keyframes.size();
  const std::size_t given = problem.closures.size();
  if (given == 0 || n < 40) return 0;
  const auto wanted = static_cast<std::size_t>(
      std::llround(static_cast<double>(given) * options.share / (1.0 - options.share)));
  Random random(options.seed, Purpose::false_closures);
  const std::size_t apart = n / 20;
  for (std::size_t added = 0; added < wanted;) {
    const auto [from, to] = std::minmax({random.index(n), random.index(n)});
    Edge edge = problem.closures[random.index(given)];
    if (to - from < apart) continue;
    edge.from = from;
    edge.to = to;
    problem.closures.push_back(edge);
    ++added;
  }
  sort_closures(problem.closures);
  return wanted;
}

}  // namespace loopbench
