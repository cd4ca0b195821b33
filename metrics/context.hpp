/// What lies behind the pairs of an evaluation, for metrics that look further.
#pragma once

#include <stdexcept>
#include <string>

#include "datasets/core/curve.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/core/sequence.hpp"
#include "metrics/protocol.hpp"

namespace loopbench {

/// Null where there is none: two files have neither problem nor curve. Nothing is owned.
struct Context {
  const Trajectory* reference = nullptr;  ///< whole, before pairing
  const Trajectory* estimate = nullptr;   ///< whole, before pairing and alignment; of a curve its
                                          ///< poses at the keyframes
  const Problem* problem = nullptr;       ///< what the method was given
  const Curve* curve = nullptr;           ///< the estimate in time, before alignment
  Times times = Times::keyframes;         ///< how the pairs were made, with `protocol`
  Protocol protocol = {};
  const std::vector<LoopCandidate>* loop_candidates = nullptr;  ///< of a place recogniser
};

/// The view, or a std::runtime_error "METRIC: needs WHAT; files have none".
template <class View>
const View& needed(const View* view, const std::string& metric, const std::string& what) {
  if (view == nullptr) throw std::runtime_error(metric + ": needs " + what + "; files have none");
  return *view;
}

}  // namespace loopbench
