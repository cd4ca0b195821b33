// A metric and a method that tests and benchmarks have in other languages, too.
#include "harness/sweep/catalogue/plugin.hpp"

using namespace loopbench;
using namespace loopbench::metrics;

namespace {

std::vector<Score> height_error(const Evaluation& evaluation) {
  std::vector<double> out;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    out.push_back(std::abs(evaluation.estimate[i].world_from_body.translation.z() -
                           evaluation.reference[i].world_from_body.translation.z()));
  }
  return {{"translation", "z", "m", statistics(std::move(out), evaluation.protocol.ddof)}};
}

}  // namespace

LOOPBENCH_PLUGIN(metric("height_error", "height error of each pose", height_error),
                 methods::method("unchanged",
                                 "the keyframes as they are",
                                 [](const Problem& problem) { return problem.keyframes; }))
