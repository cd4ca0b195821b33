// Time per method and problem size, for all methods of the catalogue.
#include <benchmark/benchmark.h>

#include "methods/pipeline.hpp"
#include "tests/support/problems.hpp"

namespace loopbench {

using namespace methods;

namespace {

/// A corrector, a smoother or a joint method: only correct or smooth, without sampling.
void run(const Stage& stage, const Problem& problem) {
  Report report;
  if (const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage)) {
    benchmark::DoNotOptimize((*corrector)->correct(problem, report));
  } else if (const auto* smoother = std::get_if<std::unique_ptr<const Smoother>>(&stage)) {
    benchmark::DoNotOptimize((*smoother)->smooth(problem, report));
  } else {
    benchmark::DoNotOptimize(
        std::get<std::unique_ptr<const Estimator>>(stage)->estimate(problem, report));
  }
}

/// A hand-held path of n keyframes with three loops for any n.
Problem sized(std::size_t n) {
  return test::drifting(test::hand_held_truth(n),
                        twist({1e-3, -1e-3, 1e-3}, {1e-4, -1e-4, 1e-4}),
                        {{0, n / 2}, {n / 4, 3 * n / 4}, {1, n - 1}});
}

void time_entry(benchmark::State& state, const MethodEntry& entry) {
  const Problem problem = sized(static_cast<std::size_t>(state.range(0)));
  const Stage stage = entry.make({});
  for (auto _ : state) run(stage, problem);
  state.SetComplexityN(state.range(0));
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  for (const loopbench::MethodEntry& entry : loopbench::methods::methods()) {
    benchmark::RegisterBenchmark(
        entry.name.c_str(),
        [entry](benchmark::State& state) { loopbench::time_entry(state, entry); })
        ->RangeMultiplier(8)
        ->Range(64, 32768)
        ->Complexity();
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
