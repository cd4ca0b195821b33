#include "metrics/doctor/graph_checks.hpp"

#include <algorithm>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  if (auto repair = find_odometry_repair(problem)) return {*repair};
  const GapCheck gaps = check_gaps(problem.closures, chain);
  const bool are_few_false = 5 * gaps.closures.size() < problem.closures.size();
  if (auto repair = find_closure_repair(problem, chain)) {
    // Smaller translations of all closures also shrink the gaps of a few false ones.
    const bool is_unit = repair->fault == Fault::closure_unit;
    if (!(is_unit && gaps.finding && are_few_false)) return {*repair};
  }
  if (gaps.finding) out.push_back(*gaps.finding);
  if (are_few_false) {  // false closures show nothing about the information
    std::vector<Edge> plausible;
    for (std::size_t i = 0; i < problem.closures.size(); ++i) {
      if (std::ranges::count(gaps.closures, i) == 0) plausible.push_back(problem.closures[i]);
    }
    if (auto found = check_information(plausible, chain)) out.push_back(*found);
  }
  std::erase_if(out, [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
  return out;
}

}  // namespace loopbench::metrics
