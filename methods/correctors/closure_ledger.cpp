#include "methods/correctors/closure_ledger.hpp"

#include <utility>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/ledger/ledger_builder.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {

std::string why_no_ledger(const Problem& problem) {
  if (problem.closures.empty() && problem.anchors.empty())
    return "the problem has no loop closures";
  if (has_scale_drift(problem)) return "edges change the scale, which the ledger does not estimate";
  if (const auto unreached = first_unconnected(problem)) {
    return "the graph is not connected: no path from keyframe " + problem.name_of(0) +
           " to keyframe " + problem.name_of(*unreached);
  }
  return "";
}

ClosureLedger closure_ledger(const Problem& problem, const LedgerSettings& settings) {
  return problem.planar ? LedgerBuilder<Se2>(problem, settings).run()
                        : LedgerBuilder<Se3>(problem, settings).run();
}

Problem trusted_problem(const Problem& problem, const ClosureLedger& ledger) {
  Problem out = problem;
  if (ledger.judgement && ledger.judgement->is_decided()) {
    ClosureJudgement stated = *ledger.judgement;
    stated.factors = {};
    out = agreed_problem(problem, stated);
  }
  out.anchors =
      ledger.anchors ? consensus::used_anchors(problem.anchors, *ledger.anchors) : problem.anchors;
  return out;
}

}  // namespace loopbench::methods
