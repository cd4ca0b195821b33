// What turning keyframes into a curve costs, and asking it ten times a keyframe.
#include <benchmark/benchmark.h>

#include "methods/method.hpp"
#include "tests/benchmarks/markdown.hpp"
#include "tests/support/problems.hpp"

namespace loopbench {
namespace {

/// A hand-held path, its keyframes shaken by about a centimetre.
Problem shaken(std::size_t size) {
  Problem out;
  out.keyframes = test::hand_held_truth(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto k = static_cast<double>(i);
    const Vector3 noise(std::sin(12.9 * k * k), std::sin(78.2 * k * k), std::sin(37.7 * k * k));
    Pose& pose = out.keyframes[i].world_from_body;
    pose.translation += 0.01 * noise;
    pose.rotation = (pose.rotation * exp_so3(0.003 * noise)).normalized();
  }
  return out;
}

void make_and_ask(benchmark::State& state, const MethodEntry& entry) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const Problem problem = shaken(size);
  const double start = problem.keyframes.front().stamp, end = problem.keyframes.back().stamp;
  std::vector<double> times(10 * size);
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k] = start + (end - start) * static_cast<double>(k) / static_cast<double>(times.size());
  }
  std::vector<Pose> poses(times.size());
  const Stage stage = entry.make({});
  const auto& smoother = std::get<std::unique_ptr<const Smoother>>(stage);
  for (auto _ : state) {
    Report report;
    smoother->smooth(problem, report)->sample(times, poses);
    benchmark::DoNotOptimize(poses.data());
  }
  state.SetComplexityN(state.range(0));
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  for (const MethodEntry& entry : methods()) {
    if (entry.kind != Kind::smoother || entry.name.starts_with("dm_") ||
        entry.name.starts_with("paper_")) {
      continue;  // dm's variants differ in nothing that costs
    }
    benchmark::RegisterBenchmark(entry.name.c_str(),
                                 [entry](benchmark::State& state) { make_and_ask(state, entry); })
        ->RangeMultiplier(10)
        ->Range(100, 10'000)
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond)
        ->Complexity();
  }
  return test::run_benchmarks(argc, argv);
}
