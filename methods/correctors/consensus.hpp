/// Pose-graph optimisation with the closures that agree, and with calibrated covariances.
#pragma once

#include <memory>
#include <utility>

#include "methods/correctors/consensus/judgement.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// Estimates factors on the stated deviations together with the closures that agree with each other
/// and with the odometry (consensus/judgement.hpp), and corrects by PoseGraphOptimizer with both.
/// Steps of the odometry that slipped, or after which the map starts again, are freed and named.
/// Outlying anchors are dropped and named (consensus/anchor_judgement.hpp), after the closures are
/// judged without anchors. If the data do not decide, the keyframes are returned unchanged.
///
/// With `gravity`, roll and pitch of each keyframe are held; closures and anchors are judged with
/// all their components.
///
/// Robust losses decide by the stated covariances: too large, and false closures pass; too small,
/// and true ones are dropped. Here the odometry's deviations are those that the closures show.
class Consensus final : public Corrector {
 public:
  struct Options {
    bool gravity = false;
    bool covariances = false;
  };
  /// `known`: judgement of the problem that will be corrected, if it was computed before.
  /// `notes_undecided`: whether a note states why closures do not decide.
  explicit Consensus(const Options& options,
                     std::shared_ptr<const ClosureJudgement> known = {},
                     bool notes_undecided = true)
      : options_(options), known_(std::move(known)), notes_undecided_(notes_undecided) {}

  /// Declines what judge_closures() does not judge, and names pose_graph. Anchors are enough.
  std::string why_declined(const Problem& problem) const override;

  bool accepts_anchors() const override { return true; }

  /// Counts: `decided` (0 or 1), `closures_kept`, `factor_t`, `factor_r` and `factor_closures` on
  /// standard deviations, `steps_freed`, `evidence` and `rival_evidence` (log odds), with anchors
  /// `anchors_kept` and `factor_anchors`, and those of PoseGraphOptimizer. Throws
  /// std::runtime_error when the solver finds no usable solution.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
  std::shared_ptr<const ClosureJudgement> known_;
  bool notes_undecided_;
};

template <class Visit>
void fields(Consensus::Options& o, Visit visit) {
  visit(
      "gravity",
      o.gravity,
      "hold roll and pitch of each keyframe as given, because gravity was measured; the z axis of "
      "the world must be vertical");
  visit("covariances", o.covariances, "state the covariance of each keyframe, for metric nees");
}

}  // namespace loopbench::methods
