#include "datasets/dataset.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "datasets/simulated/simulated.hpp"
#include "datasets/trajectory_dataset.hpp"

namespace loopbench {

std::vector<DatasetEntry> datasets() {
  return {
      simulated_entry(),
      dataset<TrajectoryOptions>(
          "trajectory",
          "keyframes, odometry and loop closures from an estimated trajectory file",
          load_trajectory),
      dataset<PoseGraphOptions>(
          "pose_graph", "g2o pose graph: odometry chain and loop closures", load_pose_graph),
  };
}

}  // namespace loopbench
