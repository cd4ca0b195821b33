#include "methods/correctors/motion_drift/large_moves.hpp"

#include <algorithm>

namespace loopbench::methods {

LargestMove largest_move(const Problem& problem,
                         const Eigen::VectorXd& gap,
                         const Trajectory& corrected) {
  const auto distance = [](const StampedPose& a, const StampedPose& b) {
    return (a.world_from_body.translation - b.world_from_body.translation).norm();
  };
  LargestMove out;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    out.moved = std::max(out.moved, distance(corrected[i], problem.keyframes[i]));
  }
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    double farthest = 0.0;
    for (const StampedPose& keyframe : problem.keyframes) {
      farthest = std::max(farthest, distance(keyframe, problem.keyframes[problem.closures[k].to]));
    }
    const auto twist = gap.segment<6>(static_cast<Eigen::Index>(6 * k));
    out.explained =
        std::max(out.explained, twist.head<3>().norm() + farthest * twist.tail<3>().norm());
  }
  return out;
}

}  // namespace loopbench::methods
