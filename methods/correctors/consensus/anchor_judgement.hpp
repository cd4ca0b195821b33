/// Judgement of the anchors of a problem, and of its stated deviations by them, without a
/// reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/anchor_runs.hpp"
#include "methods/correctors/consensus/anchor_search.hpp"
#include "methods/correctors/consensus/judge.hpp"
#include "methods/correctors/consensus/judged_anchors.hpp"
#include "methods/correctors/consensus/judgement.hpp"

namespace loopbench::methods::consensus {

/// Estimates which anchors agree with the edges and with each other, and by which factors the
/// stated deviations are wrong.
///
/// An anchor is true, with its covariance times an unknown factor, or an outlier: uniform over the
/// box of the positions. Each is compared with what all other anchors that agree predict in the
/// solution without it (leave one out, to first order). From all anchors, the most unlikely are
/// dropped until none is likelier an outlier, then those that became likely return. Consecutive
/// anchors that a common shift makes agree with the others are dropped together (anchor_runs.hpp).
/// With `is_calibrated`, the information of the odometry is right; otherwise a common factor on its
/// deviations, from 1/16 to 256, is the one under which the anchors predict each other best.
///
/// Closures are taken as true. About 30 solutions of the pose graph, 5 if `is_calibrated`;
/// more where errors change suddenly (shifted_run()).
/// Deterministic. Requires edges of scale 1 that connect all keyframes, and at least one anchor.
/// Throws std::runtime_error if no solution is found.
inline AnchorJudgement judge_anchors(const Problem& problem, bool is_calibrated) {
  std::optional<AnchorExplanation> found = best_explanation(AnchorSearch(problem), is_calibrated);
  if (!found) throw std::runtime_error("the anchors cannot be judged: no solution is found");
  AnchorJudgement out;
  if (auto shifted = shifted_run(problem, *found, is_calibrated)) {
    const bool is_checked = is_calibrated && is_spanned(shifted->run, problem);
    if (is_checked || is_mostly_dropped(shifted->run, *found)) shifted->run.is_end = false;
    if (!shifted->run.is_end) found = std::move(shifted->without);
    out.run = shifted->run;
  }
  out.factor = std::exp(found->log_anchors);
  out.odometry = std::exp(found->log_odometry);
  for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
    const PredictedAnchor& each = found->predicted[i];
    const bool agrees = found->is_kept[i] && found->log_odds[i] >= 0.0;
    out.anchors.push_back({agrees, found->log_odds[i], each.error.norm()});
    out.agreeing += agrees ? 1 : 0;
    if (agrees) out.evidence += found->log_odds[i];
  }
  const bool is_all = out.agreeing == problem.anchors.size();
  out.is_decided =
      is_all || (2 * out.agreeing > problem.anchors.size() && out.evidence > kLogNeeded);
  return out;
}

/// The same after a judgement of the closures: with those that agree and their factors, or, if they
/// do not decide, without closures.
inline AnchorJudgement judge_anchors(const Problem& problem, const ClosureJudgement& closures) {
  ClosureJudgement used = closures;
  if (!used.is_decided()) used = {};
  used.closures.resize(problem.closures.size());
  Problem agreed = agreed_problem(problem, used);
  agreed.anchors = problem.anchors;
  return judge_anchors(agreed, used.is_decided() && used.evidence > 0.0);
}

}  // namespace loopbench::methods::consensus
