/// What lies behind the pairs of an evaluation, for metrics that look further.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/pose_matrix.hpp"
#include "datasets/core/sequence.hpp"
#include "metrics/evaluation/undefined.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

/// Both lists with the digits of their files, in the files' order; set when both hold matrices.
struct PrintedPoses {
  std::vector<PoseMatrix> reference;
  std::vector<PoseMatrix> estimate;
};

/// Null where there is none: two files have neither problem nor curve. Nothing is owned.
struct Context {
  const Trajectory* reference = nullptr;  ///< whole, before pairing
  const Trajectory* estimate = nullptr;   ///< whole, before pairing and alignment; of a curve its
                                          ///< poses at the keyframes
  const Problem* problem = nullptr;       ///< what the method was given
  const Curve* curve = nullptr;           ///< the estimate in time, before alignment
  Times times = Times::keyframes;         ///< how the pairs were made, with `protocol`
  Protocol protocol;
  const PrintedPoses* printed = nullptr;  ///< what rounded text became `reference` and `estimate`
  /// What the place recogniser thought, accepted or not; empty where none ran.
  const std::vector<LoopCandidate>* loop_candidates = nullptr;
};

/// The view, or Undefined "METRIC: needs WHAT; files have none".
template <class View>
const View& needed(const View* view, const std::string& metric, const std::string& what) {
  if (view == nullptr) throw Undefined(metric + ": needs " + what + "; files have none");
  return *view;
}

}  // namespace loopbench
