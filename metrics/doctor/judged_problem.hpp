/// What the judgement of the closures of a problem states about its edges.
#pragma once

#include <optional>
#include <vector>

#include "methods/correctors/consensus/judgement.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// A problem, and the judgement of its closures.
class JudgedProblem {
 public:
  /// `known`: judgement of this problem, if it was computed before.
  JudgedProblem(Problem problem, const methods::ClosureJudgement* known);

  /// Whether the closures decide. Those of edges that change the scale are not judged.
  bool is_decided() const { return judgement_ && judgement_->is_decided(); }

  /// Whether nearly all closures agree, with the stated deviations: nothing is wrong with them.
  bool is_as_stated() const;

  /// Closures that disagree, steps of the odometry that they exclude, and deviations that are not
  /// those stated. Empty if the closures do not decide.
  std::vector<InputFinding> findings() const;

 private:
  std::optional<InputFinding> gap(bool is_drift_known) const;
  std::optional<InputFinding> step() const;
  std::optional<InputFinding> information() const;

  Problem problem_;
  std::optional<methods::ClosureJudgement> judgement_;
};

}  // namespace loopbench::metrics
