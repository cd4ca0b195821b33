#include "tests/studies/planted_edges.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/formats/g2o.hpp"

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
    out.keyframes.push_back({static_cast<double>(i), {}});
    if (i + 1 < graph.ids.size() && steps[i] != nullptr) out.odometry.push_back(*steps[i]);
  }
  std::ranges::sort(out.closures, {}, [](const Edge& e) { return std::pair(e.to, e.from); });
  return out;
}

}  // namespace

std::vector<PlantedEdges> edge_faults() {
  const auto each_closure = [](auto change) {
    return [=](Problem& p) {
      for (Edge& edge : p.closures) change(edge);
    };
  };
  const auto exchange = [](Edge& e) {
    const Matrix6 given = e.information;
    e.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
    e.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
  };
  return {{"closures inverted", metrics::Fault::closure_direction, each_closure([](Edge& e) {
             e.from_from_to = e.from_from_to.inverse();
           })},
          {"a false closure",
           metrics::Fault::closure_gap,
           [](Problem& p) {
             const std::size_t n = p.keyframes.size();
             p.closures.push_back({n / 5, 3 * n / 5, Pose{}, p.closures.front().information});
           }},
          {"information x 1e6",
           metrics::Fault::information_scale,
           [](Problem& p) {
             for (Edge& e : p.closures) e.information *= 1e6;
             for (Edge& e : p.odometry) e.information *= 1e6;
           }},
          {"rotation first in the information", metrics::Fault::information_order, [=](Problem& p) {
             for (Edge& e : p.closures) exchange(e);
             for (Edge& e : p.odometry) exchange(e);
           }}};
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
