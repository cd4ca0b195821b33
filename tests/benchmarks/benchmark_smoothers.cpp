// Time of smoothers: fitting a curve to a thousand to a million keyframes, and sampling a curve of
// 200 keyframes at a thousand to a million stamps.
#include <algorithm>
#include <cmath>

#include "methods/method.hpp"
#include "tests/benchmarks/sizes.hpp"

namespace loopbench {

using namespace methods;

namespace {

struct Timed {
  const char* name = "";
  std::int64_t most = 1'000'000;  ///< keyframes; fewer if fitting needs many passes
};
constexpr Timed kSmoothers[] = {{"polyline"},
                                {"cubic_spline"},
                                {"b_spline"},
                                {"smoothing_spline"},
                                {"gp_wnoa", 10'000},
                                {"dm_n3"},
                                {"dm_n4"},
                                {"dm_n5"},
                                {"dm_m7"},
                                {"dm_robust"}};
constexpr std::size_t kKeyframes = 200;  // of the sampled curve

/// A hand-held walk without stops, three keyframes per second.
Problem walk(std::size_t size) {
  Problem out;
  for (std::size_t i = 0; i < size; ++i) {
    const double t = 0.3 * static_cast<double>(i);
    out.keyframes.push_back(
        {t,
         {exp_so3({0.1 * std::sin(0.9 * t), 0.1 * std::cos(0.7 * t), 0.4 * t}),
          Vector3(2.0 * std::sin(0.17 * t), 1.5 * std::sin(0.23 * t), 0.2 * std::sin(0.4 * t))}});
  }
  return out;
}

std::unique_ptr<const Smoother> default_smoother(const MethodEntry& entry) {
  return std::get<std::unique_ptr<const Smoother>>(entry.make({}));
}

void smooth(const MethodEntry& entry, std::size_t size, benchmark::State& state) {
  const Problem& problem = test::kept<walk>(size);
  const auto smoother = default_smoother(entry);
  for (auto _ : state) {
    Report report;
    benchmark::DoNotOptimize(smoother->smooth(problem, report));
  }
}

void smooth_and_ask(const MethodEntry& entry, std::size_t count, benchmark::State& state) {
  const Problem& problem = test::kept<walk>(kKeyframes);
  const auto smoother = default_smoother(entry);
  std::vector<double> times(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(count);
    times[k] = u * problem.keyframes.back().stamp;
  }
  std::vector<Pose> poses(count);
  for (auto _ : state) {
    Report report;
    smoother->smooth(problem, report)->sample(times, poses);
    benchmark::DoNotOptimize(poses.data());
  }
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  const std::vector<MethodEntry> known = methods::methods();
  const auto time = [&](const std::string& what, bool is_limited, auto work) {
    for (const auto& [name, most] : kSmoothers) {
      const auto entry = std::ranges::find(known, name, &MethodEntry::name);
      if (entry == known.end()) continue;
      test::register_sizes(what + name,
                           is_limited ? most : Timed{}.most,
                           [work, method = *entry](std::size_t size, benchmark::State& state) {
                             work(method, size, state);
                           });
    }
  };
  time("smooth ", true, smooth);
  time("200 keyframes asked ", false, smooth_and_ask);
  return test::run_benchmarks(argc, argv);
}
