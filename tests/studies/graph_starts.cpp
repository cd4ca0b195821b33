// Starts of pose-graph optimisation on the public graphs in $LOOPBENCH_DATA and on sphere2500 with
// more noise: chordal relaxation, which estimates the rotations and then the positions, against a
// joint relaxation of both. The latter is the idea of FAST-Sync (Holmes et al., RA-L 11(9), 2026,
// 10.1109/LRA.2026.3710327), after the description of GTSAM's implementation, with the weights of
// the chordal cost instead of one deviation per edge. Prints a Markdown table.
#include <fmt/format.h>

#include <Eigen/SVD>
#include <chrono>
#include <random>

#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/initial_values.hpp"
#include "metrics/correction/chordal_matrix.hpp"
#include "tests/support/public_graphs.hpp"

namespace loopbench {
namespace {

using methods::PoseGraphOptimizer;
using Start = PoseGraphOptimizer::Start;

/// Minimises tr(X M X') with pose 0 fixed, without constraints, and projects the rotations.
template <int D>
Trajectory joint_relaxation(const Problem& problem) {
  using Matrix = metrics::ChordalMatrix<D>;
  constexpr int kSize = Matrix::kSize;
  const Matrix M(problem);
  methods::BlockCholesky<kSize> factor(M.structure());
  using Block = typename Matrix::Block;
  const auto diagonal = [&](Eigen::Index i) { return i == 0 ? Block::Identity() : M.diagonal(i); };
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(kSize * M.size(), D);
  const Eigen::Matrix<double, D, kSize> first = Matrix::columns({StampedPose{}});
  M.template assemble<kSize>(factor, diagonal, [&](const auto& link) -> Block {
    if (link.from != 0) return link.block();
    right.middleRows<kSize>(kSize * link.to) -= (first * link.block()).transpose();
    return Block::Zero();
  });
  right.topRows<kSize>() = first.transpose();
  if (!factor.factorise()) throw std::runtime_error("joint relaxation: the matrix is singular");
  factor.solve(right);
  Trajectory out = problem.keyframes;
  for (std::size_t i = 1; i < out.size(); ++i) {
    const auto X = right.middleRows<kSize>(kSize * static_cast<Eigen::Index>(i));
    Matrix3 rotation = Matrix3::Identity();
    rotation.topLeftCorner<D, D>() = X.template bottomRows<D>().transpose();
    const Eigen::JacobiSVD<Matrix3> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector3 signs = Vector3::Ones();
    signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant();
    Pose pose;
    pose.rotation =
        Rotation(Matrix3(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()));
    pose.translation.head<D>() = X.row(0).transpose();
    out[i].world_from_body = out[0].world_from_body * pose;
  }
  return out;
}

Trajectory chordal(const Problem& problem) {
  Trajectory out = problem.keyframes;
  const std::vector<methods::ScaledPose> values = methods::chordal_values(problem, 0.01);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].world_from_body = values[i].pose;
  return out;
}

template <class Relaxation>
void print(const std::string& name, const char* start, Problem problem, Relaxation relax) {
  const auto begin = std::chrono::steady_clock::now();
  problem.keyframes = relax(problem);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
  methods::Report report;
  PoseGraphOptimizer({.start = Start::keyframes, .max_iterations = 200}).correct(problem, report);
  const auto count = [&](const std::string& of) {
    for (const methods::Count& each : report.counts) {
      if (each.name == of) return each.value;
    }
    return 0.0;
  };
  fmt::print("| {} | {} | {:.6g} | {:.0f} | {:.6g} | {:.0f} |\n",
             name,
             start,
             count("chi2_before"),
             count("iterations"),
             count("chi2"),
             time.count());
  std::fflush(stdout);
}

void compare(const std::string& name, const Problem& problem) {
  print(name, "chordal", problem, chordal);
  print(name, "joint", problem, [](const Problem& of) {
    return of.planar ? joint_relaxation<2>(of) : joint_relaxation<3>(of);
  });
}

/// Rotates the measurement of each edge by normal noise of this deviation per axis [rad].
Problem with_noise(Problem problem, double sigma) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, sigma);
  for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) {
      const double x = noise(random);
      const double y = noise(random);
      edge.from_from_to.rotation *= exp_so3({x, y, noise(random)});
    }
  }
  return problem;
}

}  // namespace
}  // namespace loopbench

int main() {
  using namespace loopbench;
  const char* root = test::required_data();
  fmt::print(
      "| graph | start | chi2 of the start | iterations | chi2 | start [ms] |\n"
      "| --- | --- | ---: | ---: | ---: | ---: |\n");
  for (const std::string name : test::kPublicGraphs) {
    const Problem problem = test::public_graph(name, root, RotationInformation::angles);
    compare(name, problem);
    if (name != "sphere2500") continue;
    for (const double sigma : {0.1, 0.2, 0.3}) {
      compare(fmt::format("sphere2500 and {} rad", sigma), with_noise(problem, sigma));
    }
  }
}
