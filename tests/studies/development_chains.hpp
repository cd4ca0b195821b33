/// Chains for the development of methods: real odometry with loops, complete and in sections. None
/// of them is held out (configs/methods_real.yaml).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace loopbench {

struct DevelopmentChain {
  std::string odometer;  ///< "KITTI 00 viso2": its chains are similar
  std::string sequence;  ///< "KITTI 00": the recording
  std::string name;
  Problem problem;
  std::vector<std::optional<Pose>> truth;  ///< world_from_body of each keyframe
};

/// For every odometer the complete chain with 1, 2, 4 ... loops, and random sections of it with 1
/// to 6 loops, one of them at least a quarter of the section long. KITTI 00 (cop_slam, viso2, loam,
/// imls, sptam), fr1_room, fr1_360 and fr1_plant with the closures of configs/methods_real.yaml;
/// INTEL, the parking garage and M3500 with a few of their long loops as closures, and the optimum
/// over all closures as ground truth. Throws DataMissing.
std::vector<DevelopmentChain> development_chains(const DataRoot& root);

/// ATE (RMSE) of the keyframes after rigid alignment [m].
double rmse_of(const Trajectory& estimate, const DevelopmentChain& chain);

}  // namespace loopbench
