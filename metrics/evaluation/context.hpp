/// Data behind the pairs of an evaluation, for metrics that need more than the pairs.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/pose_matrix.hpp"
#include "datasets/core/sequence.hpp"
#include "metrics/evaluation/undefined.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// Poses of both files with the digits as printed, in file order; set if both files hold matrices.
struct PrintedPoses {
  std::vector<PoseMatrix> reference;
  std::vector<PoseMatrix> estimate;
};

/// Non-owning pointers, null where the data do not exist: two files have neither problem nor curve.
struct Context {
  const Trajectory* reference = nullptr;  ///< complete, before pairing
  const Trajectory* estimate = nullptr;   ///< complete, before pairing and alignment; for a curve
                                          ///< its poses at the keyframes
  const Problem* problem = nullptr;       ///< input of the method
  const Curve* curve = nullptr;           ///< continuous-time estimate, before alignment
  Times times = Times::keyframes;         ///< evaluation times of the pairs
  Protocol protocol;
  const PrintedPoses* printed =
      nullptr;  ///< the printed matrices behind `reference` and `estimate`
  /// Candidates of the place recognition, accepted or not; empty without place recognition.
  const std::vector<LoopCandidate>* loop_candidates = nullptr;
};

/// Dereferences the view. Throws Undefined "METRIC: needs WHAT, which files do not have" if null.
template <class View>
const View& needed(const View* view, const std::string& metric, const std::string& what) {
  if (view == nullptr) throw Undefined(metric + ": needs " + what + ", which files do not have");
  return *view;
}

}  // namespace loopbench::metrics
