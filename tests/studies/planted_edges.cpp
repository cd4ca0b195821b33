#include "tests/studies/planted_edges.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/formats/g2o.hpp"
#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/closure_checks.hpp"
#include "metrics/doctor/common_motion.hpp"

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

void invert_closures(Problem& problem) {
  for (Edge& edge : problem.closures) edge.from_from_to = edge.from_from_to.inverse();
}

void add_false_closure(Problem& problem) {
  const std::size_t n = problem.keyframes.size();
  problem.closures.push_back({n / 5, 3 * n / 5, Pose{}, problem.closures.front().information});
}

/// Of every `every`-th edge, from the first on.
void multiply_information(std::vector<Edge>& edges, double factor, std::size_t every = 1) {
  for (std::size_t i = 0; i < edges.size(); i += every) edges[i].information *= factor;
}

void exchange_blocks(Edge& edge) {
  const Matrix6 given = edge.information;
  edge.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
  edge.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
}

std::string always(const Problem&) { return ""; }

/// The unmodified information is already reported as too small.
std::string unless_too_small(const Problem& problem) {
  const bool is_reported = std::ranges::any_of(
      metrics::check_closures(problem),
      [](const metrics::InputFinding& f) { return f.fault == metrics::Fault::information_scale; });
  return is_reported ? "as stated, the information is already 10^6 times too small" : "";
}

std::size_t pairs_of(const Problem& problem) {
  return metrics::neighbours_of(problem.closures, metrics::chain_of(problem)).size();
}

/// Without two closures between the same sections, the drift hides how exact closures are.
std::string unless_isolated(const Problem& problem) {
  return pairs_of(problem) == 0
             ? "no two closures connect the same sections, so that none can be compared"
             : "";
}

/// A single pair does not show which of its closures is wrong, or whether all are.
std::string unless_few_pairs(const Problem& problem) {
  constexpr std::size_t kFewest = 3;
  const std::size_t pairs = pairs_of(problem);
  return pairs < kFewest
             ? fmt::format(
                   "{} pairs of closures connect the same sections, too few to single out "
                   "a closure",
                   pairs)
             : "";
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
  return ratio > kAlike ? ""
                        : fmt::format(
                              "the stated standard deviations of translation [m] and "
                              "rotation [rad] have a ratio of {:.2f} (median)",
                              ratio);
}

}  // namespace

std::vector<PlantedEdges> edge_faults() {
  using metrics::Fault;
  return {{"closures inverted", Fault::closure_direction, invert_closures, always},
          {"a false closure", Fault::closure_gap, add_false_closure, always},
          {"information x 1e6",
           Fault::information_scale,
           [](Problem& p) {
             multiply_information(p.closures, 1e6);
             multiply_information(p.odometry, 1e6);
           },
           unless_too_small},
          {"information of the odometry x 1e6",
           Fault::information_scale,
           [](Problem& p) { multiply_information(p.odometry, 1e6); },
           unless_too_small},
          {"information of the closures / 1e6",
           Fault::information_scale,
           [](Problem& p) { multiply_information(p.closures, 1e-6); },
           unless_isolated},
          {"information of every tenth closure / 1e6",
           Fault::edge_covariance,
           [](Problem& p) { multiply_information(p.closures, 1e-6, 10); },
           unless_few_pairs},
          {"rotation first in the information",
           Fault::information_order,
           [](Problem& p) {
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
                                 "pose_graphs/parking-garage.g2o"}) {
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
