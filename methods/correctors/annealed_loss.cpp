#include "methods/correctors/annealed_loss.hpp"

#include <algorithm>
#include <utility>

namespace loopbench {

bool is_bounded(Loss loss) { return loss == Loss::dcs || loss == Loss::switchable; }

double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve) {
  const std::vector<ScaledPose> start = poses;
  const std::vector<double> squared = squared_errors(start, closures, settings);
  const PoseGraphSummary direct = solve(settings);
  std::vector<ScaledPose> reached = std::exchange(poses, start);
  PoseGraphSettings rough = settings;
  rough.max_iterations = std::min(settings.max_iterations, 30);
  rough.tolerance = std::max(settings.tolerance, 1e-6);
  // Smoother than dcs and as bounded: fewer wrong minima on the way.
  rough.loss = Loss::switchable;
  double width = *std::ranges::max_element(squared);
  for (; width > 2.0 * settings.loss_width; width *= 0.5) {
    rough.loss_width = width;
    solve(rough);
  }
  if (!(solve(settings).cost < direct.cost)) poses = std::move(reached);
  return direct.cost_before;
}

}  // namespace loopbench
