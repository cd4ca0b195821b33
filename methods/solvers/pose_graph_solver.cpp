#include "methods/solvers/pose_graph_solver.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/solvers/edge_residual.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/pose_graph_costs.hpp"

namespace loopbench::methods {
namespace {

/// The anchor in the world of pose 0.
Anchor relative_to(const Pose& world_from_first, Anchor anchor) {
  const Matrix3 R = world_from_first.rotation.toRotationMatrix();
  anchor.position = world_from_first.inverse() * anchor.position;
  anchor.covariance = R.transpose() * anchor.covariance * R;
  return anchor;
}

/// rho and its first two derivatives; x is the squared residual.
class DynamicCovarianceScaling final : public ceres::LossFunction {
 public:
  explicit DynamicCovarianceScaling(double width) : width_(width) {}
  void Evaluate(double x, double rho[3]) const override {
    if (x <= width_) {
      rho[0] = x, rho[1] = 1.0, rho[2] = 0.0;
      return;
    }
    const double sum = width_ + x;
    const double four = 4.0 * width_ * width_;
    rho[0] = 3.0 * width_ - four / sum, rho[1] = four / (sum * sum);
    rho[2] = -2.0 * four / (sum * sum * sum);
  }

 private:
  double width_;
};

class SwitchableConstraint final : public ceres::LossFunction {
 public:
  explicit SwitchableConstraint(double width) : width_(width) {}
  void Evaluate(double x, double rho[3]) const override {
    const double sum = width_ + x;
    const double s = width_ / sum;  // the switch
    rho[0] = s * x, rho[1] = s * s, rho[2] = -2.0 * s * s / sum;
  }

 private:
  double width_;
};

std::unique_ptr<ceres::LossFunction> make_loss(const PoseGraphSettings& settings) {
  const double width = settings.loss_width;
  switch (settings.loss) {
    case RobustLoss::none:
      return nullptr;
    case RobustLoss::huber:
      return std::make_unique<ceres::HuberLoss>(std::sqrt(width));
    case RobustLoss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(std::sqrt(width));
    case RobustLoss::dcs:
      return std::make_unique<DynamicCovarianceScaling>(width);
    case RobustLoss::switchable:
      return std::make_unique<SwitchableConstraint>(width);
  }
  return nullptr;
}

ceres::Solver::Options solver_options(const PoseGraphSettings& settings) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = settings.tolerance;
  // Only the change of the cost ends the iterations: gradients depend on units, and steps on the
  // length of the trajectory.
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-16;
  // Long chains have directions with 1e-9 of the stiffness of their diagonal, along which Ceres's
  // default damping of 1e-4 converges very slowly. Unsuccessful steps shrink the region quickly.
  options.initial_trust_region_radius = 1e12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

/// Whether the last steps were rejected although they exceed rounding: the cost is flat to its
/// rounding error, but the poses have not converged. On long chains 1e-12 of the cost corresponds
/// to a tenth of a millimetre.
bool stalled(const ceres::Solver::Summary& summary) {
  constexpr double kConverged = 1e-6;  // [m], [rad], norm over all poses
  if (summary.termination_type != ceres::CONVERGENCE) return false;
  double rejected = 0.0;
  for (auto last = summary.iterations.rbegin(); last != summary.iterations.rend(); ++last) {
    if (last->step_is_successful) break;
    rejected = last->step_norm;  // ends with the earliest of them, which is damped least
  }
  return rejected > kConverged;
}

/// Options for a few more steps that may raise the cost.
ceres::Solver::Options polishing_options(const PoseGraphSettings& settings) {
  constexpr int kMaxIterations = 50;
  ceres::Solver::Options options = solver_options(settings);
  options.max_num_iterations = std::min(kMaxIterations, settings.max_iterations);
  options.use_nonmonotonic_steps = true;
  return options;
}

/// Poses are expressed relative to pose 0: a large distance from the world origin costs no
/// precision, and the motion plane need not be horizontal in the world.
template <class G>
PoseGraphSummary solve_in(std::vector<ScaledPose>& poses,
                          const std::vector<Edge>& odometry,
                          const std::vector<Edge>& closures,
                          const std::vector<double>& weights,
                          const PoseGraphSettings& settings) {
  const ScaledPose world_from_first = poses.front();
  const ScaledPose first_from_world = world_from_first.inverse();
  RightPerturbation<G> manifold;
  const auto loss = make_loss(settings);
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem problem(problem_options);
  std::vector<std::array<double, static_cast<std::size_t>(G::kSize)>> blocks(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    G::write(G::from(first_from_world * poses[i]), blocks[i].data());
    problem.AddParameterBlock(blocks[i].data(), G::kSize, &manifold);
  }
  const auto add = [&](const Edge& edge, double weight, ceres::LossFunction* rho) {
    problem.AddResidualBlock(new EdgeCost<G>(edge, weight, settings.scale_sigma),
                             rho,
                             blocks[edge.from].data(),
                             blocks[edge.to].data());
  };
  for (const Edge& edge : odometry) add(edge, 1.0, nullptr);
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (weights[k] > 0.0) add(closures[k], weights[k], loss.get());
  }
  if constexpr (G::kDof <= 6) {
    for (const Anchor& anchor : settings.anchors) {
      problem.AddResidualBlock(new AnchorCost<G>(relative_to(world_from_first.pose, anchor)),
                               nullptr,
                               blocks[anchor.keyframe].data());
    }
  }
  if (!settings.is_first_free) problem.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(settings), &problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("pose graph: " + summary.message);
  int linear_solves = summary.num_linear_solves;
  double cost = summary.final_cost;
  if (stalled(summary)) {
    ceres::Solver::Summary polished;
    ceres::Solve(polishing_options(settings), &problem, &polished);
    if (!polished.IsSolutionUsable()) throw std::runtime_error("pose graph: " + polished.message);
    linear_solves += polished.num_linear_solves;
    cost = polished.final_cost;
  }
  for (std::size_t i = settings.is_first_free ? 0 : 1; i < poses.size(); ++i) {
    poses[i] = normalized(world_from_first * G::to_scaled_pose(G::read(blocks[i].data())));
  }
  return {
      linear_solves, summary.initial_cost, cost, summary.termination_type == ceres::CONVERGENCE};
}

template <class G>
std::vector<double> squared_in(const std::vector<ScaledPose>& poses,
                               const std::vector<Edge>& edges,
                               double scale_sigma) {
  std::vector<double> out;
  out.reserve(edges.size());
  const ScaledPose first_from_world = poses.front().inverse();
  const auto relative_pose = [&](std::size_t i) { return G::from(first_from_world * poses[i]); };
  for (const Edge& edge : edges) {
    const auto back = G::inverse(G::from(measured(edge)));
    const auto from_from_to =
        G::compose(G::inverse(relative_pose(edge.from)), relative_pose(edge.to));
    const typename G::Tangent e = group_edge_error<G>(back, from_from_to);
    out.push_back(e.dot(G::information(edge, scale_sigma) * e));
  }
  return out;
}

}  // namespace

PoseGraphSummary solve_pose_graph(std::vector<ScaledPose>& poses,
                                  const std::vector<Edge>& odometry,
                                  const std::vector<Edge>& closures,
                                  const std::vector<double>& weights,
                                  const PoseGraphSettings& settings) {
  if (poses.empty()) return {};
  switch (settings.group) {
    case Group::se2:
      return solve_in<Se2>(poses, odometry, closures, weights, settings);
    case Group::se3:
      return solve_in<Se3>(poses, odometry, closures, weights, settings);
    case Group::sim3:
      return solve_in<Sim3>(poses, odometry, closures, weights, settings);
  }
  return {};
}

std::vector<double> squared_errors(const std::vector<ScaledPose>& poses,
                                   const std::vector<Edge>& edges,
                                   const PoseGraphSettings& settings) {
  if (edges.empty()) return {};
  switch (settings.group) {
    case Group::se2:
      return squared_in<Se2>(poses, edges, settings.scale_sigma);
    case Group::se3:
      return squared_in<Se3>(poses, edges, settings.scale_sigma);
    case Group::sim3:
      return squared_in<Sim3>(poses, edges, settings.scale_sigma);
  }
  return {};
}

}  // namespace loopbench::methods
