#include "metrics/path_length.hpp"

#include <stdexcept>

namespace loopbench {

std::vector<Score> path_length_ratio(const Evaluation& evaluation, const PathLengthOptions&) {
  const double estimate = path_length(evaluation.estimate);
  const double reference = path_length(evaluation.reference);
  if (reference == 0.0) throw Undefined("path_length: the reference stands still");
  return {single("ratio", "", "1", estimate / reference),
          single("estimate", "", "m", estimate),
          single("reference", "", "m", reference)};
}

}  // namespace loopbench
