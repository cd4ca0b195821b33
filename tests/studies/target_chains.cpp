#include "tests/studies/target_chains.hpp"

#include <algorithm>

#include "datasets/derive/poses_at.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "methods/correctors/scale_drift.hpp"

namespace loopbench {

using namespace methods;

std::vector<DevelopmentChain> target_chains(const DataRoot& root) {
  std::vector<DevelopmentChain> out;
  const auto add = [&](const std::string& name, const TrajectoryOptions& options) {
    Sequence sequence = load_trajectory(options, root);
    DevelopmentChain& chain =
        out.emplace_back(DevelopmentChain{name, name, name, std::move(sequence.problem), {}});
    chain.problem.frames.clear();
    chain.truth = poses_at(sequence.reference, stamps(chain.problem.keyframes), {});
  };
  TrajectoryOptions room;
  room.estimate = "tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt";
  room.reference = "tum_rgbd/fr1_room/groundtruth.txt";
  room.closures = ClosureSource::estimate;
  room.closures_file = "tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run1.txt";
  add("fr1_room, 20 closures", room);
  room.closures_max = 8;
  add("fr1_room, 8 closures", room);
  TrajectoryOptions office = room;
  office.estimate = "tum_rgbd/fr3_office/orbslam2_mono_open_keyframes.txt";
  office.reference = "tum_rgbd/fr3_office/groundtruth.txt";
  office.closures_file = "tum_rgbd/fr3_office/orbslam2_mono_closed_frames.txt";
  office.closures_scale = ClosureScale::local;
  add("fr3_office monocular", office);
  return out;
}

DevelopmentChain with_exact_closures(const DevelopmentChain& chain) {
  DevelopmentChain out = chain;
  std::erase_if(out.problem.closures,
                [&](const Edge& loop) { return !chain.truth[loop.from] || !chain.truth[loop.to]; });
  const bool is_scaled = has_scale_drift(chain.problem);
  std::vector<double> lengths{0.0}, true_lengths{0.0};
  for (const Edge& edge : chain.problem.odometry) {
    const bool known = chain.truth[edge.from] && chain.truth[edge.to];
    const double length = edge.from_from_to.translation.norm();
    lengths.push_back(lengths.back() + (known ? length : 0.0));
    true_lengths.push_back(
        true_lengths.back() +
        (known ? (chain.truth[edge.from]->translation - chain.truth[edge.to]->translation).norm()
               : 0.0));
  }
  // The scale of a monocular keyframe is that of the ten edges on each side.
  const auto local_scale = [&](std::size_t keyframe) {
    const std::size_t first = keyframe > 10 ? keyframe - 10 : 0;
    const std::size_t last = std::min(keyframe + 10, lengths.size() - 1);
    return (lengths[last] - lengths[first]) / (true_lengths[last] - true_lengths[first]);
  };
  for (Edge& loop : out.problem.closures) {
    loop.from_from_to = normalized(chain.truth[loop.from]->inverse() * *chain.truth[loop.to]);
    if (!is_scaled) continue;
    loop.from_from_to.translation *= local_scale(loop.from);
    loop.scale = local_scale(loop.from) / local_scale(loop.to);
  }
  return out;
}

}  // namespace loopbench
