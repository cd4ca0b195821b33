// A correct plugin whose method computes with OpenMP.
#include "harness/sweep/catalogue/plugin.hpp"

using namespace loopbench;
using namespace loopbench::methods;

namespace {

struct InParallel final : Corrector {
  using Options = NoOptions;
  explicit InParallel(const Options&) {}
  Trajectory correct(const Problem& problem, Report& report) const override {
    double length = 0.0;
#pragma omp parallel for reduction(+ : length) num_threads(4)
    for (std::size_t i = 1; i < problem.keyframes.size(); ++i) {
      length += (problem.keyframes[i].world_from_body.translation -
                 problem.keyframes[i - 1].world_from_body.translation)
                    .norm();
    }
    report.count("length", length);
    return problem.keyframes;
  }
};

}  // namespace

LOOPBENCH_PLUGIN(method<InParallel>("in_parallel", "adds in several threads"))
