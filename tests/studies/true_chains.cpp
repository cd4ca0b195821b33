#include "tests/studies/true_chains.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "datasets/derive/odometry.hpp"
#include "datasets/derive/poses_at.hpp"
#include "datasets/derive/revisits.hpp"
#include "datasets/simulated/simulated.hpp"
#include "datasets/trajectory_dataset.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMostKeyframes = 400;

/// Root of the mean squared errors of the odometry per axis, as its stated deviations.
void state_true_deviations(TrueChain& chain) {
  const int axes_t = chain.problem.planar ? 2 : 3, axes_r = chain.problem.planar ? 1 : 3;
  double t = 0.0, r = 0.0;
  for (const Edge& edge : chain.problem.odometry) {
    const Pose step =
        chain.truth[edge.from].world_from_body.inverse() * chain.truth[edge.to].world_from_body;
    const Twist error = log_se3(edge.from_from_to.inverse() * step);
    t += chain.problem.planar ? error.head<2>().squaredNorm() : error.head<3>().squaredNorm();
    r += chain.problem.planar ? error[5] * error[5] : error.tail<3>().squaredNorm();
  }
  const auto edges = static_cast<double>(chain.problem.odometry.size());
  const Matrix6 information = isotropic_information(std::max(1e-12, t / edges / axes_t),
                                                    std::max(1e-16, r / edges / axes_r));
  for (Edge& edge : chain.problem.odometry) edge.information = information;
}

void find_true_revisits(TrueChain& chain, const RevisitRule& rule) {
  constexpr std::size_t kMostRevisits = 120;
  const std::vector<Revisit> all = find_revisits(chain.truth, rule);
  for (const std::size_t k : subsample(all, stamps(chain.truth), kMostRevisits)) {
    const Pose& from = chain.truth[all[k].from].world_from_body;
    const Pose& to = chain.truth[all[k].to].world_from_body;
    chain.revisits.push_back({all[k].from, all[k].to, from.inverse() * to});
  }
}

/// The chain of poses with a true pose, thinned to kMostKeyframes.
TrueChain chain_of(std::string name, const Sequence& sequence, const RevisitRule& rule) {
  const Trajectory& all = sequence.problem.keyframes;
  const auto truth = poses_at(sequence.reference, stamps(all), {2.0, 0.1});
  const std::size_t every = 1 + (all.size() - 1) / kMostKeyframes;
  TrueChain out;
  out.name = std::move(name);
  out.problem.planar = sequence.problem.planar;
  for (std::size_t i = 0; i < all.size(); i += every) {
    if (!truth[i]) continue;
    out.problem.keyframes.push_back(all[i]);
    out.truth.push_back({all[i].stamp, *truth[i]});
  }
  out.problem.odometry = odometry_edges(out.problem.keyframes, {});
  state_true_deviations(out);
  find_true_revisits(out, rule);
  return out;
}

/// Unit vector along which the true positions have the least extent: the vertical of a vehicle.
Vector3 least_extent(const Trajectory& truth) {
  Vector3 mean = Vector3::Zero();
  for (const StampedPose& each : truth) {
    mean += each.world_from_body.translation / static_cast<double>(truth.size());
  }
  Matrix3 scatter = Matrix3::Zero();
  for (const StampedPose& each : truth) {
    const Vector3 offset = each.world_from_body.translation - mean;
    scatter += offset * offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3>(scatter).eigenvectors().col(0);
}

struct Recorded {
  const char* estimate;
  const char* reference;
  bool is_planar;
};

}  // namespace

std::vector<TrueChain> recorded_chains(const std::filesystem::path& data) {
  std::vector<TrueChain> out;
  for (const auto& [estimate, reference, is_planar] : {
           Recorded{"kitti/00/kiss_icp_open.txt", "kitti/00/gt_poses.txt", false},
           Recorded{"kitti/00/imls_lidar_odom_open.txt", "kitti/00/gt_poses.txt", false},
           Recorded{"kitti/00/simple_lidar_odom_open.txt", "kitti/00/gt_poses.txt", false},
           Recorded{"kitti/00/orbslam2_stereo.txt", "kitti/00/gt_poses.txt", false},
           Recorded{"kitti/02/steam_icp_open.txt", "kitti/02/gt_poses.txt", false},
           Recorded{"kitti/02/elastic_icp_open.txt", "kitti/02/gt_poses.txt", false},
           Recorded{"kitti/05/kiss_icp_open.txt", "kitti/05/gt_poses.txt", false},
           Recorded{"kitti/05/steam_lo_open.txt", "kitti/05/gt_poses.txt", false},
           Recorded{"kitti/05/loam_open.txt", "kitti/05/gt_poses.txt", false},
           Recorded{"kitti/06/simple_lidar_odom_open.txt", "kitti/06/gt_poses.txt", false},
           Recorded{"kitti/06/kiss_icp_open.txt", "kitti/06/gt_poses.txt", false},
           Recorded{"kitti/07/elastic_icp_open.txt", "kitti/07/gt_poses.txt", false},
           Recorded{"kitti/07/kiss_icp_open.txt", "kitti/07/gt_poses.txt", false},
           Recorded{"kitti/09/loam_open.txt", "kitti/09/gt_poses.txt", false},
           Recorded{"mulran/DCC_01/odometry.txt", "mulran/DCC_01/reference.txt", false},
           Recorded{"mulran/Riverside_01/odometry.txt", "mulran/Riverside_01/reference.txt", false},
           Recorded{"wheel/B25b/odometry.txt", "wheel/B25b/reference.txt", true},
           Recorded{"wheel/Corridor/odometry.txt", "wheel/Corridor/reference.txt", true},
           Recorded{"tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt",
                    "tum_rgbd/fr1_room/groundtruth.txt",
                    false},
       }) {
    TrajectoryOptions options;
    options.estimate = estimate;
    options.reference = reference;
    options.repeats = Repeats::keep_last;
    const Sequence sequence = load_trajectory(options, DataRoot{{data}});
    const std::string name = estimate;
    const bool is_car = name.starts_with("kitti") || name.starts_with("mulran");
    TrueChain chain = chain_of(name, sequence, {is_car ? 4.0 : 0.7, 0.5, 10.0});
    chain.problem.planar = is_planar;
    chain.sigma_t = is_car ? 0.1 : 0.02;
    chain.sigma_r = is_car ? 0.005 : 0.01;
    if (is_planar) state_true_deviations(chain);
    if (chain.revisits.size() >= 8) out.push_back(std::move(chain));
  }
  return out;
}

std::vector<TrueChain> simulated_chains(std::int64_t first, int count) {
  std::vector<TrueChain> out;
  for (std::int64_t seed = first; seed < first + count; ++seed) {
    SimulatedOptions options;
    const bool is_drive = seed % 2 == 0;
    options.path = is_drive ? SimulatedPath::driving : SimulatedPath::office;
    options.planar = seed % 4 == 0;
    options.seed = seed;
    options.laps = 2;
    options.keyframes = 200;
    options.closures.max = 0;
    TrueChain chain = chain_of("simulated " + to_text(options.path) + " " + std::to_string(seed),
                               load_simulated(options),
                               {is_drive ? 4.0 : 0.7, 0.5, 10.0});
    chain.problem.planar = options.planar;
    chain.sigma_t = is_drive ? 0.1 : 0.02;
    chain.sigma_r = is_drive ? 0.005 : 0.01;
    out.push_back(std::move(chain));
  }
  return out;
}

TrueChain biased(TrueChain chain) {
  constexpr double kScale = 0.02;
  const double yaw_rate = 0.02 * M_PI / 180.0;  // [rad/s]
  const Vector3 axis = chain.problem.planar ? Vector3::UnitZ() : least_extent(chain.truth);
  Trajectory& keyframes = chain.problem.keyframes;
  const Trajectory given = keyframes;
  for (std::size_t k = 1; k < given.size(); ++k) {
    const Pose& end = given[k].world_from_body;
    Pose step = given[k - 1].world_from_body.inverse() * end;
    step.translation *= 1.0 + kScale;
    const Vector3 turn = yaw_rate * (given[k].stamp - given[k - 1].stamp) *
                         (chain.truth[k].world_from_body.rotation.conjugate() * axis);
    const Pose moved = step * exp_se3(twist(Vector3::Zero(), turn));
    keyframes[k].world_from_body = normalized(keyframes[k - 1].world_from_body * moved);
  }
  chain.problem.odometry = odometry_edges(keyframes, {});
  state_true_deviations(chain);
  return chain;
}

}  // namespace loopbench
