#include "metrics/correction/path_length.hpp"

namespace loopbench::metrics {

std::vector<Score> path_length_ratio(const Evaluation& evaluation) {
  const double estimate = path_length(evaluation.estimate);
  const double reference = path_length(evaluation.reference);
  if (reference == 0.0) throw Undefined("path_length: the reference does not move");
  return {directed(single("ratio", "", "1", estimate / reference), Better::target, 1.0),
          directed(single("estimate", "", "m", estimate), Better::neither),
          directed(single("reference", "", "m", reference), Better::neither)};
}

}  // namespace loopbench::metrics
