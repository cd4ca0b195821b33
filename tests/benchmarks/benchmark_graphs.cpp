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
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/residuals.hpp"
#include "metrics/correction/optimality.hpp"
#include "tests/benchmarks/peak_memory.hpp"

namespace loopbench {

using namespace methods;

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

using Sparse = Eigen::SparseMatrix<double>;

/// J' Omega J at the keyframes, with the first one fixed.
template <class G>
Sparse normal_equations(const Problem& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto element = [&](std::size_t i) {
    const Pose& first = problem.keyframes[0].world_from_body;
    return G::from({first.inverse() * problem.keyframes[i].world_from_body, 1.0});
  };
  for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (const Edge& edge : *edges) {
      const auto at = edge_residual<G>(
          G::inverse(G::from(measured(edge))), element(edge.from), element(edge.to));
      const auto W = G::information(edge, 1.0);
      const std::size_t ends[] = {edge.from, edge.to};
      const typename G::Square* J[] = {&at.by_from, &at.by_to};
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          if (ends[a] == 0 || ends[b] == 0) continue;
          const typename G::Square block = J[a]->transpose() * W * *J[b];
          const auto row = static_cast<int>(ends[a] - 1) * G::kDof;
          const auto column = static_cast<int>(ends[b] - 1) * G::kDof;
          for (int r = 0; r < G::kDof; ++r) {
            for (int c = 0; c < G::kDof; ++c)
              entries.emplace_back(row + r, column + c, block(r, c));
          }
        }
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(problem.keyframes.size() - 1) * G::kDof;
  Sparse H(size, size);
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

template <class Factor>
void factorise(const Problem& problem, benchmark::State& state) {
  const Sparse H = problem.planar ? normal_equations<Se2>(problem) : normal_equations<Se3>(problem);
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
