// A complete pose-graph solve, by the direct solver and by Ceres, compared with one sparse
// factorisation of its normal equations by Eigen and by CHOLMOD and with the certificate of its
// result, on the public graphs in $LOOPBENCH_DATA: times, iterations, and the memory of all.
#include <benchmark/benchmark.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>

#include "datasets/pose_graph_dataset.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "metrics/correction/optimality.hpp"
#include "tests/benchmarks/normal_equations.hpp"
#include "tests/benchmarks/peak_memory.hpp"

namespace loopbench {

using namespace methods;
using test::Sparse;

namespace {

constexpr const char* kPublicGraphs[] = {"intel",
                                         "INTEL_1228_with_vertices",
                                         "MIT",
                                         "M3500_with_vertices",
                                         "city10000",
                                         "smallGrid3D",
                                         "parking-garage",
                                         "sphere2500",
                                         "torus3D",
                                         "cubicle"};

template <class Factor>
void factorise(const Problem& problem, benchmark::State& state) {
  const Sparse H = test::normal_equations(problem);
  const double before = test::reset_peak();
  for (auto _ : state) {
    Factor factor(H);
    if (factor.info() != Eigen::Success) state.SkipWithError("not positive definite");
    benchmark::DoNotOptimize(factor);
  }
  state.counters["MB"] = test::peak_megabytes() - before;
}

void correct(const Corrector& method, const Problem& problem, benchmark::State& state) {
  Report report;
  const double before = test::reset_peak();
  for (auto _ : state) {
    report = {};
    benchmark::DoNotOptimize(method.correct(problem, report));
  }
  state.counters["MB"] = test::peak_megabytes() - before;
  for (const Count& count : report.counts) {
    if (count.name == "iterations") state.counters["iterations"] = count.value;
    if (count.name.ends_with("chi2")) state.counters["chi2"] = count.value;
  }
}

void certify(const Corrector& method, const Problem& problem, benchmark::State& state) {
  Report report;
  const Trajectory poses = method.correct(problem, report);
  metrics::Certificate proof;
  for (auto _ : state) proof = metrics::certificate(problem, poses);
  state.counters["gap_percent"] = 100.0 * (1.0 - proof.lower_bound / proof.minimum);
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  benchmark::Initialize(&argc, argv);
  const char* root = std::getenv("LOOPBENCH_DATA");
  std::map<std::string, Problem> problems;
  const Dual dual({});
  const PoseGraphOptimizer pose_graph({});
  using Start = PoseGraphOptimizer::Start;
  const PoseGraphOptimizer direct({.start = Start::chordal});
  // The loss has no effect, but selects Ceres.
  const PoseGraphOptimizer ceres(
      {.start = Start::chordal, .loss = RobustLoss::huber, .loss_width = 1e15});
  const PoseGraphOptimizer rough({.start = Start::chordal, .tolerance = 1e-6});
  const auto time = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
  };
  for (const std::string name : kPublicGraphs) {
    if (root == nullptr) continue;
    try {
      PoseGraphOptions options;
      options.path = "pose_graphs/" + name + ".g2o";
      options.rules.indefinite = IndefiniteInformation::repair;
      const Problem& problem =
          problems.emplace(name, load_pose_graph(options, {{root}}).problem).first->second;
      time("SimplicialLDLT " + name, [&](benchmark::State& state) {
        factorise<Eigen::SimplicialLDLT<Sparse, Eigen::Lower>>(problem, state);
      });
      time("CHOLMOD " + name, [&](benchmark::State& state) {
        factorise<Eigen::CholmodDecomposition<Sparse, Eigen::Lower>>(problem, state);
      });
      time("pose_graph " + name, [&](benchmark::State& state) { correct(direct, problem, state); });
      time("rough " + name, [&](benchmark::State& state) { correct(rough, problem, state); });
      time("certificate " + name,
           [&](benchmark::State& state) { certify(direct, problem, state); });
      time("Ceres " + name, [&](benchmark::State& state) { correct(ceres, problem, state); });
    } catch (const DataMissing& missing) {
      std::cerr << missing.what() << '\n';
    }
  }
  try {
    PoseGraphOptions options;
    options.path = "cop_slam/KITTI_00_vo.g2o";
    options.keyframes_every = 10;
    if (root == nullptr) throw DataMissing("LOOPBENCH_DATA is not set");
    const Problem& problem =
        problems.emplace("KITTI_00", load_pose_graph(options, {{root}}).problem).first->second;
    time("chain KITTI_00 dual", [&](benchmark::State& state) { correct(dual, problem, state); });
    time("chain KITTI_00 pose_graph",
         [&](benchmark::State& state) { correct(pose_graph, problem, state); });
  } catch (const DataMissing& missing) {
    std::cerr << missing.what() << '\n';
  }
  if (problems.empty()) std::cerr << "no pose graphs found: set LOOPBENCH_DATA\n";
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
