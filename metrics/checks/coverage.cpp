#include "metrics/checks/coverage.hpp"

namespace loopbench::metrics {

std::vector<Score> coverage(const Evaluation& evaluation) {
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
