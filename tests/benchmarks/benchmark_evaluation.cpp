// Time of each step of an evaluation, from a thousand poses to ten million.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "datasets/formats/formats.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/pairing/association.hpp"
#include "tests/benchmarks/sizes.hpp"

namespace loopbench {

using namespace metrics;

namespace {

/// A car at 10 m/s on a spiral, ten poses per second; with the amplitude 1, it has drift, noise of
/// centimetres and stamp errors up to 2 ms.
template <int kAmplitude>
Trajectory drive(std::size_t size) {
  constexpr double amplitude = kAmplitude;
  Trajectory out(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto k = static_cast<double>(i);
    const double yaw = 0.02 * k + 0.3 * std::sin(0.01 * k);
    const Vector3 noise(std::sin(12.9 * k), std::sin(78.2 * k), std::sin(37.7 * k));
    out[i].stamp = 1.3e9 + 0.1 * k + 0.002 * amplitude * noise.x();
    out[i].world_from_body = {exp_so3(Vector3(0.0, 0.0, yaw) + 1e-3 * amplitude * noise),
                              Vector3(50.0 * std::cos(0.02 * k), 50.0 * std::sin(0.02 * k), 1.0) +
                                  0.01 * amplitude * noise};
  }
  return out;
}

const Trajectory& reference(std::size_t size) { return test::kept<drive<0>>(size); }

const Trajectory& estimate(std::size_t size) { return test::kept<drive<1>>(size); }

/// A file name unique to this process.
std::filesystem::path written(const std::string& name, const Trajectory& poses) {
  const std::string file = "loopbench_" + std::to_string(getpid()) + "_" + name + ".txt";
  const std::filesystem::path path = std::filesystem::temp_directory_path() / file;
  write_tum(path, poses);
  return path;
}

void parse_tum(std::size_t size, benchmark::State& state) {
  const std::filesystem::path file = written("estimate", estimate(size));
  for (auto _ : state) benchmark::DoNotOptimize(read_trajectory(file));
  state.SetBytesProcessed(static_cast<std::int64_t>(std::filesystem::file_size(file)) *
                          state.iterations());
  std::filesystem::remove(file);
}

template <Association kAssociation>
void pair_up(std::size_t size, benchmark::State& state) {
  Protocol protocol;
  protocol.association = kAssociation;
  protocol.max_gap = 1.0;
  const Trajectory& Q = reference(size);
  const Trajectory& P = estimate(size);
  for (auto _ : state) benchmark::DoNotOptimize(associate(Q, P, protocol));
}

void align_se3(std::size_t size, benchmark::State& state) {
  const Trajectory& Q = reference(size);
  const Trajectory& P = estimate(size);
  for (auto _ : state) benchmark::DoNotOptimize(align(Q, P, Align::se3));
}

Evaluation evaluation(std::size_t size) {
  Evaluation out;
  out.reference = reference(size);
  out.estimate = estimate(size);
  return out;
}

void score_ate(std::size_t size, benchmark::State& state) {
  const Evaluation pairs = evaluation(size);
  for (auto _ : state) benchmark::DoNotOptimize(ate(pairs, {}));
}

template <int kDelta, DeltaUnit kUnit>
void score_rpe(std::size_t size, benchmark::State& state) {
  RpeOptions options;
  options.delta = kDelta;
  options.unit = kUnit;
  const Evaluation pairs = evaluation(size);
  for (auto _ : state) benchmark::DoNotOptimize(rpe(pairs, options));
}

void score_segments(std::size_t size, benchmark::State& state) {
  Evaluation pairs = evaluation(size);
  pairs.reference_length = path_length(pairs.reference);
  for (auto _ : state) benchmark::DoNotOptimize(segments(pairs, {.lengths = "", .each = false}));
}

/// The work of `eval` for two files, without printing and diagnostics.
void files_to_scores(std::size_t size, benchmark::State& state) {
  const std::filesystem::path truth = written("reference", reference(size));
  const std::filesystem::path guess = written("estimate", estimate(size));
  for (auto _ : state) {
    const Evaluation pairs = evaluate(read_trajectory(truth), read_trajectory(guess), Protocol{});
    benchmark::DoNotOptimize(ate(pairs, {}));
    benchmark::DoNotOptimize(axis_error(pairs, {}));
    for (const DeltaUnit unit : {DeltaUnit::frames, DeltaUnit::s, DeltaUnit::m}) {
      benchmark::DoNotOptimize(rpe(pairs, {.delta = 1.0, .unit = unit}));
    }
    benchmark::DoNotOptimize(segments(pairs, {.lengths = "", .each = false}));
  }
  std::filesystem::remove(truth);
  std::filesystem::remove(guess);
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  const auto time = [](const char* name, void (*run)(std::size_t, benchmark::State&)) {
    test::register_sizes(name, 10'000'000, run);
  };
  time("parse_tum", parse_tum);
  time("associate_nearest", pair_up<Association::nearest>);
  time("associate_evo", pair_up<Association::evo>);
  time("associate_interpolate", pair_up<Association::interpolate>);
  time("align_se3", align_se3);
  time("ate", score_ate);
  time("rpe_1_frame", score_rpe<1, DeltaUnit::frames>);
  time("rpe_1_s", score_rpe<1, DeltaUnit::s>);
  time("rpe_100_m", score_rpe<100, DeltaUnit::m>);
  time("segments", score_segments);
  time("files_to_scores", files_to_scores);
  return test::run_benchmarks(argc, argv);
}
