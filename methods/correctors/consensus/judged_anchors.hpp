/// What is found about the anchors of a problem.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "datasets/core/anchor.hpp"

namespace loopbench::methods::consensus {

struct JudgedAnchor {
  bool agrees = true;
  /// Log odds of true over an outlier, given all others that agree [-]; 0: they do not predict it.
  double log_odds = 0.0;
  double metres = 0.0;  ///< distance from the position that the others predict
};

/// Consecutive anchors that agree with each other, and with the rest after a common shift.
struct AnchorRun {
  std::size_t first = 0, last = 0;  ///< anchors of the problem, both included
  double metres = 0.0;              ///< size of the shift
  /// Nothing but odometry is before or after them: it can be the cause as well, so that they are
  /// not dropped.
  bool is_end = false;
};

struct AnchorJudgement {
  std::vector<JudgedAnchor> anchors;  ///< one per anchor of the problem
  double factor = 1.0;                ///< on their stated deviations [-]
  double odometry = 1.0;              ///< on the deviations of the odometry [-]
  std::optional<AnchorRun> run;       ///< unset: none
  std::size_t agreeing = 0;
  double evidence = 0.0;   ///< log odds of those that agree, summed [-]
  bool is_decided = true;  ///< none is dropped, or more than half agree with enough evidence
};

/// The anchors that are used: those that agree, none if nothing is decided. O(anchors).
inline std::vector<Anchor> used_anchors(const std::vector<Anchor>& anchors,
                                        const AnchorJudgement& judgement) {
  std::vector<Anchor> out;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (judgement.is_decided && judgement.anchors[i].agrees) out.push_back(anchors[i]);
  }
  return out;
}

}  // namespace loopbench::methods::consensus
