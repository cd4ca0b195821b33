/// How much worse a score became.
#pragma once

#include <cmath>

#include "harness/answers/gate/gate.hpp"

namespace loopbench::harness {

/// How much worse a value became, in its unit; negative if it became better.
inline double loss(const ScoreKind& kind, double before, double now) {
  switch (kind.better) {
    case metrics::Better::lower:
      return now - before;
    case metrics::Better::higher:
      return before - now;
    case metrics::Better::target:
      return std::abs(now - kind.target) - std::abs(before - kind.target);
    case metrics::Better::neither:
      return std::abs(now - before);
  }
  return 0.0;
}

/// Whether at most a hundredth of an error is left. Times can shrink that much.
inline bool has_vanished(const Record& score, double before, double now) {
  if (is_measured_time(score)) return false;
  const ScoreKind& kind = *score.kind;
  if (kind.better != metrics::Better::lower && kind.better != metrics::Better::target) return false;
  const double best = kind.better == metrics::Better::target ? kind.target : 0.0;
  return std::abs(now - best) <= 0.01 * std::abs(before - best);
}

}  // namespace loopbench::harness
