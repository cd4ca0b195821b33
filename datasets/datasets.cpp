#include "datasets/dataset.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "datasets/simulated/simulated.hpp"
#include "datasets/trajectory_dataset.hpp"

namespace loopbench {

std::vector<DatasetEntry> datasets() {
  return {
      dataset<SimulatedOptions>(
          "simulated", "closed-form paths, odometry that errs, closures", load_simulated),
      dataset<TrajectoryOptions>(
          "trajectory", "a problem derived from an estimate file", load_trajectory),
      dataset<PoseGraphOptions>("pose_graph", "a g2o chain with its loop edges", load_pose_graph),
  };
}

}  // namespace loopbench
