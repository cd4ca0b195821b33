#include "tests/studies/development_chains.hpp"

#include <cmath>
#include <random>

#include "datasets/derive/poses_at.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "metrics/errors/ate.hpp"

namespace loopbench {

using namespace methods;
using namespace metrics;

namespace {

/// Use of one odometer's chain in the study.
struct ChainUse {
  std::string odometer;
  std::string sequence;
  std::vector<std::size_t> loops;  ///< numbers of loops of the complete chain
  int sections = 0;
  std::uint64_t seed = 0;
  double shortest = 0.2;  ///< section length, relative to the chain
  double longest = 0.7;
};

class ChainMaker {
 public:
  explicit ChainMaker(const DataRoot& root) : root_(root) {}

  void use_graph(const ChainUse& use, const PoseGraphOptions& options) {
    const Sequence sequence = load_pose_graph(options, root_);
    add(use, sequence.problem, truth_of(sequence));
  }

  void use_trajectory(const ChainUse& use, const TrajectoryOptions& options) {
    const Sequence sequence = load_trajectory(options, root_);
    add(use, sequence.problem, truth_of(sequence));
  }

  /// Uses the optimum over all closures as ground truth; the chain is the composed odometry.
  void use_optimum(const ChainUse& use, const std::string& path) {
    PoseGraphOptions options;
    options.path = path;
    Problem problem = load_pose_graph(options, root_).problem;
    PoseGraphOptimizer::Options from_chords;
    from_chords.start = PoseGraphOptimizer::Start::chordal;
    Report report;
    std::vector<std::optional<Pose>> truth;
    for (const auto& [stamp, pose] : PoseGraphOptimizer(from_chords).correct(problem, report)) {
      truth.push_back(pose);
    }
    Trajectory& keyframes = problem.keyframes;
    for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
      keyframes[i + 1].world_from_body =
          normalized(keyframes[i].world_from_body * problem.odometry[i].from_from_to);
    }
    const std::size_t least = keyframes.size() / 10;
    std::erase_if(problem.closures, [&](const Edge& e) { return e.to - e.from <= least; });
    keep(problem, subsample(problem.closures.size(), 60));
    add(use, problem, truth);
  }

  std::vector<DevelopmentChain> chains;

 private:
  static std::vector<std::optional<Pose>> truth_of(const Sequence& sequence) {
    return poses_at(sequence.reference, stamps(sequence.problem.keyframes), {});
  }

  /// At most `most` evenly spaced indices of 0 .. size - 1.
  static std::vector<std::size_t> subsample(std::size_t size, std::size_t most) {
    std::vector<std::size_t> out;
    const std::size_t count = std::min(size, most);
    for (std::size_t i = 0; i < count; ++i) out.push_back(i * size / count);
    return out;
  }

  static void keep(Problem& problem, const std::vector<std::size_t>& closures) {
    std::vector<Edge> kept;
    for (const std::size_t k : closures) kept.push_back(problem.closures[k]);
    problem.closures = std::move(kept);
  }

  void add(const ChainUse& use,
           const Problem& problem,
           const std::vector<std::optional<Pose>>& truth) {
    DevelopmentChain complete{use.odometer, use.sequence, "", problem, truth};
    complete.problem.frames.clear();
    for (const std::size_t loops : use.loops) {
      if (loops > problem.closures.size()) continue;
      DevelopmentChain& chain = chains.emplace_back(complete);
      chain.name = use.odometer + ", " + std::to_string(loops) + " loops";
      keep(chain.problem, subsample(problem.closures.size(), loops));
    }
    add_sections(use, complete);
  }

  void add_sections(const ChainUse& use, const DevelopmentChain& complete) {
    std::mt19937_64 bits(use.seed);
    const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
    const auto keyframes = static_cast<double>(complete.truth.size());
    int added = 0;
    for (int tries = 0; tries < 4000 && added < use.sections; ++tries) {
      const double share = use.shortest + (use.longest - use.shortest) * uniform();
      const auto length = static_cast<std::size_t>(share * keyframes);
      const auto begin =
          static_cast<std::size_t>(uniform() * (keyframes - static_cast<double>(length)));
      std::vector<std::size_t> inside;
      for (std::size_t k = 0; k < complete.problem.closures.size(); ++k) {
        const Edge& loop = complete.problem.closures[k];
        if (loop.from >= begin && loop.to < begin + length) inside.push_back(k);
      }
      if (inside.empty()) continue;
      const std::size_t wanted = 1 + static_cast<std::size_t>(uniform() * 6.0);
      std::vector<std::size_t> kept;
      std::size_t farthest = 0;
      for (const std::size_t i : subsample(inside.size(), wanted)) {
        const Edge& loop = complete.problem.closures[inside[i]];
        kept.push_back(inside[i]);
        farthest = std::max(farthest, loop.to - loop.from);
      }
      if (farthest < length / 4) continue;
      chains.push_back(section_of(complete, begin, length, kept));
      chains.back().name = use.odometer + ", section " + std::to_string(++added);
    }
  }

  static DevelopmentChain section_of(const DevelopmentChain& complete,
                                     std::size_t begin,
                                     std::size_t length,
                                     const std::vector<std::size_t>& closures) {
    const auto part = [&](const auto& all, std::size_t size) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
      return std::vector(first, first + static_cast<std::ptrdiff_t>(size));
    };
    DevelopmentChain out = complete;
    out.problem.keyframes = part(complete.problem.keyframes, length);
    out.problem.odometry = part(complete.problem.odometry, length - 1);
    out.truth = part(complete.truth, length);
    keep(out.problem, closures);
    for (std::vector<Edge>* edges : {&out.problem.odometry, &out.problem.closures}) {
      for (Edge& edge : *edges) {
        edge.from -= begin;
        edge.to -= begin;
      }
    }
    return out;
  }

  const DataRoot& root_;
};

void use_kitti(ChainMaker& make) {
  PoseGraphOptions cop_slam;
  cop_slam.path = "cop_slam/KITTI_00_vo.g2o";
  cop_slam.truth = "cop_slam/KITTI_00_gt.g2o";
  cop_slam.keyframes_every = 10;
  make.use_graph({"KITTI 00 cop_slam", "KITTI 00", {1, 2, 4, 9}, 14, 11}, cop_slam);

  PoseGraphOptions viso2;
  viso2.path = "kitti/00/viso2_loops_se2.g2o";
  viso2.truth = "kitti/00/gt_poses.txt";
  viso2.truth_axes = TruthAxes::kitti_camera;
  viso2.reference_body.x = 2.24;
  viso2.reference_body.y = -0.1;
  viso2.keyframes_every = 5;
  make.use_graph({"KITTI 00 viso2", "KITTI 00", {1, 2, 4, 12, 30}, 14, 12}, viso2);

  TrajectoryOptions lidar;
  lidar.reference = "kitti/00/gt_poses.txt";
  lidar.keyframes = {KeyframeRule::every, 5};
  lidar.closures = ClosureSource::reference;
  lidar.closures_max = 40;
  lidar.closures_radius = 4.0;
  const std::vector<std::size_t> loops{1, 2, 4, 8, 16};
  lidar.estimate = "kitti/00/loam_open.txt";
  make.use_trajectory({"KITTI 00 loam", "KITTI 00", loops, 14, 21}, lidar);
  TrajectoryOptions stereo = lidar;
  stereo.estimate = "kitti/00/sptam_stereo_open.txt";
  lidar.estimate = "kitti/00/imls_lidar_odom_open.txt";
  lidar.reference_body.z = 0.27;
  make.use_trajectory({"KITTI 00 imls", "KITTI 00", loops, 14, 22}, lidar);
  make.use_trajectory({"KITTI 00 sptam", "KITTI 00", loops, 14, 23}, stereo);
}

void use_rooms(ChainMaker& make) {
  TrajectoryOptions camera;
  camera.closures = ClosureSource::reference;
  camera.closures_max = 30;
  camera.closures_radius = 0.5;
  camera.closures_angle = 45.0;
  const auto use = [&](const std::string& what,
                       const std::string& sequence,
                       const std::string& folder,
                       const std::string& file,
                       int sections,
                       std::uint64_t seed) {
    camera.estimate = "tum_rgbd/" + folder + "/" + file;
    camera.reference = "tum_rgbd/" + folder + "/groundtruth.txt";
    make.use_trajectory({what, sequence, {1, 2, 4, 8}, sections, seed, 0.3, 0.9}, camera);
  };
  use("fr1_room, ORB-SLAM2", "fr1_room", "fr1_room", "orbslam2_rgbd_open_keyframes.txt", 10, 31);
  camera.keyframes = {KeyframeRule::every, 10};
  use("fr1_360, RGB-D SLAM", "fr1_360", "other/fr1_360", "rgbdslam_frames.txt", 8, 41);
  use("fr1_room, RGB-D SLAM", "fr1_room", "fr1_room", "rgbdslam_frames.txt", 8, 41);
  use("fr1_plant, RGB-D SLAM", "fr1_plant", "other/fr1_plant", "rgbdslam_frames.txt", 8, 41);
}

}  // namespace

std::vector<DevelopmentChain> development_chains(const DataRoot& root) {
  ChainMaker make(root);
  use_kitti(make);
  use_rooms(make);
  const auto use = [&](const std::string& name, const std::string& file, std::uint64_t seed) {
    make.use_optimum({name, name, {1, 2, 4, 8}, 10, seed}, "pose_graphs/" + file);
  };
  use("INTEL", "INTEL_1228_with_vertices.g2o", 51);
  use("parking garage", "parking-garage.g2o", 52);
  use("M3500, simulated", "M3500_with_vertices.g2o", 53);
  return std::move(make.chains);
}

double rmse_of(const Trajectory& estimate, const DevelopmentChain& chain) {
  Trajectory known, reference;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!chain.truth[i]) continue;
    known.push_back(estimate[i]);
    reference.push_back({estimate[i].stamp, *chain.truth[i]});
  }
  Protocol by_index;
  by_index.association = Association::index;
  return ate(evaluate(reference, known, by_index), {}).front().statistics.rmse;
}

}  // namespace loopbench
