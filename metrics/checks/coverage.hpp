/// Share of the estimate and of the reference that was evaluated.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Single values. In 0..1, each with count = evaluated pairs and std = 0: relation `share` (pairs
/// over possible pairs) and `span` (evaluated time, without tracking gaps, over the reference's
/// duration). `bridged` [s]: duration of tracking gaps that the curve bridges; 0 at keyframes.
inline std::vector<Score> coverage(const Evaluation& evaluation) {
  const Coverage& found = evaluation.coverage;
  const auto single = [&](const std::string& relation, double value) {
    Score score{relation, "", "1", statistics({value})};
    score.statistics.count = found.pairs;
    return score;
  };
  return descriptions({single("share", found.share()),
                       single("span", found.span),
                       metrics::single("bridged", "", "s", found.bridged)});
}

}  // namespace loopbench::metrics
