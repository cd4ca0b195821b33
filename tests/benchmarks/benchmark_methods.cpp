// Time of each method, also of those of the plugins (shared objects) named after the options, for
// the room of configs/profile.yaml with one revisit. Smoothers fit the drifted keyframes.
#include <exception>
#include <filesystem>

#include "datasets/simulated/simulated.hpp"
#include "harness/sweep/catalogue/plugins.hpp"
#include "methods/method.hpp"
#include "tests/benchmarks/sizes.hpp"

namespace loopbench {

using namespace methods;

namespace {

Problem room(std::size_t keyframes) {
  const Params options{{"path", std::string("room")},
                       {"frame_rate", 100.0},
                       {"keyframes", static_cast<std::int64_t>(keyframes)}};
  return simulated_entry().load(options, {}).problem;
}

void run_once(const Stage& stage, const Problem& problem, Report& report) {
  if (const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage)) {
    benchmark::DoNotOptimize((*corrector)->correct(problem, report));
  } else if (const auto* smoother = std::get_if<std::unique_ptr<const Smoother>>(&stage)) {
    benchmark::DoNotOptimize((*smoother)->smooth(problem, report));
  } else if (const auto* joint = std::get_if<std::unique_ptr<const Estimator>>(&stage)) {
    benchmark::DoNotOptimize((*joint)->estimate(problem, report));
  }
}

std::string reason_to_skip(const Stage& stage, const Problem& problem) {
  if (const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage)) {
    return reason_to_decline(**corrector, problem);
  }
  if (const auto* smoother = std::get_if<std::unique_ptr<const Smoother>>(&stage)) {
    return (*smoother)->why_declined(problem);
  }
  if (const auto* joint = std::get_if<std::unique_ptr<const Estimator>>(&stage)) {
    return reason_to_decline(**joint, problem);
  }
  return "runs another method";
}

void time_method(const MethodEntry& entry, std::size_t keyframes, benchmark::State& state) {
  const Problem& problem = test::kept<room>(keyframes);
  try {
    const Stage stage = entry.make({});
    const std::string reason = reason_to_skip(stage, problem);
    if (!reason.empty()) return state.SkipWithError(reason.c_str());
    for (auto _ : state) {
      Report report;
      run_once(stage, problem, report);
    }
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

void add(const MethodEntry& entry) {
  if (entry.kind == Kind::replay) return;
  test::register_sizes(
      "method " + entry.name, 1'000, [entry](std::size_t keyframes, benchmark::State& state) {
        time_method(entry, keyframes, state);
      });
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  int options = 1;  // and the program's name
  while (options < argc && argv[options][0] == '-') ++options;
  for (const MethodEntry& entry : methods::methods()) add(entry);
  for (int i = options; i < argc; ++i) {
    for (const harness::PluginEntry& each : harness::load_plugin(argv[i])) {
      if (const auto* entry = std::get_if<MethodEntry>(&each)) add(*entry);
    }
  }
  return test::run_benchmarks(options, argv);
}
