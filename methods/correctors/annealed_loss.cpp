#include "methods/correctors/annealed_loss.hpp"

#include <algorithm>
#include <utility>

namespace loopbench::methods {

bool is_bounded(RobustLoss loss) {
  return loss == RobustLoss::dcs || loss == RobustLoss::switchable;
}

std::vector<double> loss_weights(const PoseGraphSettings& settings, std::vector<double> squared) {
  const double width = settings.loss_width;
  for (double& x : squared) {
    const double root = (settings.loss == RobustLoss::dcs ? 2.0 : 1.0) * width / (width + x);
    x = std::min(1.0, root * root);
  }
  return squared;
}

double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve) {
  const std::vector<ScaledPose> start = poses;
  const std::vector<double> squared = squared_errors(start, closures, settings);
  const PoseGraphSummary direct = solve(settings);
  poses = start;
  PoseGraphSettings intermediate = settings;
  intermediate.max_iterations = std::min(settings.max_iterations, 30);
  intermediate.tolerance = std::max(settings.tolerance, 1e-6);
  // The switchable loss is smoother than dcs and also bounded, so it has fewer false minima.
  intermediate.loss = RobustLoss::switchable;
  double width = *std::ranges::max_element(squared);
  for (; width > 1.4 * settings.loss_width; width *= 0.7) {
    intermediate.loss_width = width;
    solve(intermediate);
  }
  constexpr double kOtherMinimum = 1e-6;  // relative cost difference that indicates another minimum
  std::vector<ScaledPose> annealed = poses;
  const bool is_lower = solve(settings).cost < direct.cost * (1.0 - kOtherMinimum);
  if (is_lower) {
    poses = std::move(annealed);
  } else {
    poses = start;
  }
  return direct.cost_before;
}

}  // namespace loopbench::methods
