/// Chains on which methods may be chosen: real odometry with loops, whole and cut. None of them is
/// held out (configs/methods_real.yaml).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace loopbench {

struct DevelopmentChain {
  std::string odometer;  ///< "KITTI 00 viso2": chains of one are alike
  std::string sequence;  ///< "KITTI 00": what was travelled
  std::string name;
  Problem problem;
  std::vector<std::optional<Pose>> truth;  ///< world_from_body, one a keyframe
};

/// Of every odometer the whole chain with 1, 2, 4 ... loops, and stretches of it drawn by seed with
/// 1 to 6 loops, one of them at least a quarter of the stretch long. KITTI 00 (cop_slam, viso2,
/// loam, imls, sptam), fr1_room, fr1_360 and fr1_plant with closures as configs/methods_real.yaml
/// has them; INTEL, the parking garage and M3500 with a few of their long loops as closures and,
/// for a truth, the optimum over all. Throws DataMissing.
std::vector<DevelopmentChain> development_chains(const DataRoot& root);

/// Root of the mean squared distance of keyframes from the truth after a rigid fit [m].
double rmse_of(const Trajectory& estimate, const DevelopmentChain& chain);

}  // namespace loopbench
