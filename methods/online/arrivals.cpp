#include "methods/online/arrivals.hpp"

#include <algorithm>
#include <random>

namespace loopbench::methods {

std::vector<Arrival> closure_arrivals(const Problem& problem, const ArrivalOptions& options) {
  std::mt19937_64 random(static_cast<std::uint64_t>(options.seed));
  // The distributions of the standard library differ between compilers.
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  };
  std::vector<Arrival> out;
  const auto arrive = [&](const Edge& closure, double earliest) {
    out.push_back({earliest + options.delay + options.jitter * uniform(), closure});
    return out.back().time;
  };
  for (const Edge& closure : problem.closures) {
    const double time = arrive(closure, problem.keyframes[closure.to].stamp);
    if (uniform() < options.repeated) arrive(closure, time);
  }
  const std::size_t n = problem.keyframes.size();
  const bool has_room = n >= 3 && !problem.closures.empty();
  for (std::int64_t i = 0; has_room && i < options.false_closures; ++i) {
    Edge closure = problem.closures[below(problem.closures.size())];
    closure.to = 2 + below(n - 2);
    closure.from = below(closure.to / 2);
    const double time = arrive(closure, problem.keyframes[closure.to].stamp);
    if (options.withdrawn_after) out.push_back({time + *options.withdrawn_after, closure, true});
  }
  std::ranges::stable_sort(out, {}, &Arrival::time);
  return out;
}

}  // namespace loopbench::methods
