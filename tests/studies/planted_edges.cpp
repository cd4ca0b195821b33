#include "tests/studies/planted_edges.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/core/se3.hpp"
#include "datasets/formats/g2o.hpp"
#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench {
namespace {

namespace fs = std::filesystem;

/// The odometry between consecutive vertices, and all other edges as closures; empty if a step is
/// missing.
Problem problem_of(const fs::path& file) {
  const PoseGraph graph = read_g2o(file);
  Problem out;
  std::vector<const Edge*> steps(graph.ids.size(), nullptr);
  for (const Edge& edge : graph.edges) {
    if (edge.to == edge.from + 1 && steps[edge.from] == nullptr) {
      steps[edge.from] = &edge;
    } else {
      out.closures.push_back(edge);
    }
  }
  for (std::size_t i = 0; i < graph.ids.size(); ++i) {
    if (i + 1 < graph.ids.size() && steps[i] != nullptr) out.odometry.push_back(*steps[i]);
  }
  Pose pose;
  for (std::size_t i = 0; i < graph.ids.size(); ++i) {
    if (i > 0 && i <= out.odometry.size()) {
      pose = normalized(pose * out.odometry[i - 1].from_from_to);
    }
    out.keyframes.push_back({static_cast<double>(i), pose});
  }
  out.planar = graph.planar;
  std::ranges::sort(out.closures, {}, [](const Edge& e) { return std::pair(e.to, e.from); });
  return out;
}

using Change = std::function<void(Edge&)>;

std::function<void(Problem&, std::mt19937&)> each_closure(const Change& change) {
  return [=](Problem& p, std::mt19937&) {
    for (Edge& edge : p.closures) change(edge);
  };
}

std::function<void(Problem&, std::mt19937&)> each_step(const Change& change) {
  return [=](Problem& p, std::mt19937&) {
    for (Edge& edge : p.odometry) change(edge);
  };
}

void invert(Edge& edge) { edge.from_from_to = edge.from_from_to.inverse(); }

void read_as_xyzw(Edge& edge) {
  const Rotation q = edge.from_from_to.rotation;
  edge.from_from_to.rotation = Rotation(q.z(), q.w(), q.x(), q.y());
}

/// Motion of a camera (right, down, forward) instead of a vehicle (forward, left, up).
void between_cameras(Edge& edge) {
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), Vector3::Zero()};
  edge.from_from_to = camera.inverse() * edge.from_from_to * camera;
}

Change times(double factor) {
  return [=](Edge& edge) { edge.from_from_to.translation *= factor; };
}

Change angles_times(double factor) {
  return [=](Edge& edge) {
    edge.from_from_to.rotation = exp_so3(factor * log_so3(edge.from_from_to.rotation));
  };
}

/// Further than any drift from where the odometry ends.
void add_false_closure(Problem& problem, std::mt19937& random) {
  const std::size_t n = problem.keyframes.size();
  const std::size_t from = n / 10 + random() % (n / 4), to = n / 2 + random() % (n / 3);
  const Pose odometry =
      problem.keyframes[from].world_from_body.inverse() * problem.keyframes[to].world_from_body;
  Edge edge = problem.closures.front();
  edge.from = from;
  edge.to = to;
  edge.from_from_to = odometry.translation.norm() > 60.0
                          ? Pose{}
                          : Pose{odometry.rotation, odometry.translation + Vector3(60, 40, 0)};
  problem.closures.push_back(edge);
}

void multiply_information(std::vector<Edge>& edges, double factor) {
  for (Edge& edge : edges) edge.information *= factor;
}

void exchange_blocks(Edge& edge) {
  const Matrix6 given = edge.information;
  edge.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
  edge.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
}

std::string always(const Problem&) { return ""; }

/// Closures that are mostly false show nothing about their information.
std::string unless_false(const Problem& problem) {
  const bool is_false =
      std::ranges::any_of(metrics::check_closures(problem), [&](const metrics::InputFinding& f) {
        return f.fault == metrics::Fault::closure_gap &&
               5.0 * f.value > static_cast<double>(problem.closures.size());
      });
  return is_false ? "more than a fifth of the closures contradict the odometry" : "";
}

/// The unmodified information is already reported as too small.
std::string unless_too_small(const Problem& problem) {
  const bool is_reported = std::ranges::any_of(
      metrics::check_closures(problem),
      [](const metrics::InputFinding& f) { return f.fault == metrics::Fault::information_scale; });
  return is_reported ? "as stated, the information is already 10^6 times too small"
                     : unless_false(problem);
}

/// Whether two different closures connect the same two sections of the odometry.
bool has_neighbours(const Problem& problem) {
  constexpr std::size_t kSearched = 12, kMostKeyframes = 15;
  constexpr double kMostMetres = 15.0;
  const metrics::Chain chain = metrics::chain_of(problem);
  const auto is_near = [&](std::size_t i, std::size_t j) {
    return std::max(i, j) - std::min(i, j) <= kMostKeyframes && chain.length(i, j) <= kMostMetres;
  };
  const std::vector<Edge>& all = problem.closures;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(all.size(), i + 1 + kSearched); ++j) {
      const bool is_copy = all[i].from == all[j].from && all[i].to == all[j].to &&
                           is_close(all[i].from_from_to, all[j].from_from_to, 0.0, 0.0);
      if (!is_copy && is_near(all[i].from, all[j].from) && is_near(all[i].to, all[j].to)) {
        return true;
      }
    }
  }
  return false;
}

/// Without two closures between the same sections, the drift hides how exact closures are.
std::string unless_isolated(const Problem& problem) {
  return has_neighbours(problem)
             ? unless_false(problem)
             : "no two closures connect the same sections, so that none can be compared";
}

/// The exchange of blocks that are alike changes little.
std::string unless_alike(const Problem& problem) {
  constexpr double kAlike = 2.01;  // of standard deviations
  std::vector<double> ratios;
  for (const auto* edges : {&problem.odometry, &problem.closures}) {
    for (const Edge& edge : *edges) {
      const Matrix6 covariance = edge.information.inverse();
      ratios.push_back(std::abs(std::log(covariance.topLeftCorner<3, 3>().trace() /
                                         covariance.bottomRightCorner<3, 3>().trace())));
    }
  }
  const double ratio = std::exp(0.5 * metrics::median_value(std::move(ratios)));
  return ratio > kAlike ? unless_false(problem)
                        : fmt::format(
                              "the stated standard deviations of translation [m] and "
                              "rotation [rad] have a ratio of {:.2f} (median)",
                              ratio);
}

/// Rotations that are nearly zero are so in any unit.
std::string unless_parallel(const Problem& problem) {
  std::vector<double> angles;
  for (const Edge& edge : problem.closures) {
    angles.push_back(angle_between(edge.from_from_to.rotation, Rotation::Identity()));
  }
  return metrics::median_value(std::move(angles)) < 0.1 ? "the closures hardly rotate" : "";
}

}  // namespace

std::vector<PlantedEdges> edge_faults() {
  constexpr double kDegree = 180.0 / M_PI;
  const auto information = [](bool of_odometry, bool of_closures, double factor) {
    return [=](Problem& p, std::mt19937&) {
      if (of_odometry) multiply_information(p.odometry, factor);
      if (of_closures) multiply_information(p.closures, factor);
    };
  };
  return {
      {"closures inverted", "closure_direction", each_closure(invert), always},
      {"odometry inverted", "odometry_direction", each_step(invert), always},
      {"closures w x y z", "closure_rotation", each_closure(read_as_xyzw), always},
      {"closures in degrees", "closure_rotation", each_closure(angles_times(kDegree)), always},
      {"closures in degrees, converted twice",
       "closure_rotation",
       each_closure(angles_times(1.0 / kDegree)),
       unless_parallel},
      {"closures of another body", "closure_frame", each_closure(between_cameras), always},
      {"closures in millimetres", "closure_unit", each_closure(times(1000.0)), always},
      {"odometry in millimetres", "closure_unit", each_step(times(1000.0)), always},
      {"a false closure", "closure_gap", add_false_closure, always},
      {"information x 1e6", "information_scale", information(true, true, 1e6), unless_too_small},
      {"information of the odometry x 1e6",
       "information_scale",
       information(true, false, 1e6),
       unless_too_small},
      {"information of the closures / 1e6",
       "information_scale",
       information(false, true, 1e-6),
       unless_isolated},
      {"rotation first in the information",
       "information_order",
       [](Problem& p, std::mt19937&) {
         for (Edge& e : p.closures) exchange_blocks(e);
         for (Edge& e : p.odometry) exchange_blocks(e);
       },
       unless_alike}};
}

std::vector<std::pair<std::string, Problem>> graphs(const fs::path& data) {
  std::vector<fs::path> files;
  for (const char* const name : {"cop_slam/KITTI_00_vo.g2o",
                                 "cop_slam/KITTI_02_vo.g2o",
                                 "cop_slam/Pittsburgh_A_vo.g2o",
                                 "kitti/00/viso2_loops_se2.g2o",
                                 "kitti/02/viso2_loops_se2.g2o",
                                 "kitti/05/viso2_loops_se2.g2o",
                                 "kitti/06/viso2_loops_se2.g2o",
                                 "kitti/07/viso2_loops_se2.g2o",
                                 "kitti/09/viso2_loops_se2.g2o",
                                 "pose_graphs/intel.g2o",
                                 "pose_graphs/INTEL_1228_with_vertices.g2o",
                                 "pose_graphs/MIT.g2o",
                                 "pose_graphs/parking-garage.g2o",
                                 "robust_slam/00/kitti_00_alpha_0.00.g2o",
                                 "robust_slam/00/kitti_00_alpha_0.50.g2o",
                                 "robust_slam/00/kitti_00_alpha_1.00.g2o"}) {
    if (fs::exists(data / name)) files.push_back(data / name);
  }
  std::vector<std::pair<std::string, Problem>> out;
  for (const fs::path& file : files) {
    Problem problem = problem_of(file);
    if (problem.closures.empty() || problem.odometry.size() + 1 != problem.keyframes.size()) {
      fmt::print(stderr, "{}: skipped, it is no complete chain with closures\n", file.string());
      continue;
    }
    out.emplace_back(file.lexically_relative(data).string(), std::move(problem));
  }
  return out;
}

}  // namespace loopbench
