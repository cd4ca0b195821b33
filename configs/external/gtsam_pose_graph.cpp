// Optimises the pose graph of a g2o file with GTSAM: gtsam_pose_graph gn|lm|start GRAPH RESULT
//   gn, lm: Gauss-Newton or Levenberg-Marquardt from the poses of the file
//   start: Gauss-Newton from GTSAM's own start, chordal in space and LAGO in the plane
// Prints the seconds of the start and the optimisation, and the iterations. GTSAM's examples print
// no time and write six digits, therefore this program. For an installed GTSAM (4.2 or later):
//   c++ -std=c++17 -O3 -DNDEBUG gtsam_pose_graph.cpp -o gtsam_pose_graph -lgtsam
// with the folder of the Eigen that GTSAM was built with as -I.
#include <gtsam/geometry/Pose2.h>
#include <gtsam/geometry/Pose3.h>
#include <gtsam/nonlinear/GaussNewtonOptimizer.h>
#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <gtsam/slam/InitializePose3.h>
#include <gtsam/slam/dataset.h>
#include <gtsam/slam/lago.h>

#include <chrono>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <string>

namespace {

bool is_spatial(const std::string& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.find("EDGE_SE3:QUAT") != std::string::npos;
}

template <class Params>
Params to_1e6() {
  Params out;
  out.maxIterations = 100;
  out.relativeErrorTol = 1e-6;
  out.absoluteErrorTol = 0.0;
  return out;
}

template <class Optimizer, class Params>
gtsam::Values optimized(const gtsam::NonlinearFactorGraph& graph, const gtsam::Values& start) {
  Optimizer optimizer(graph, start, to_1e6<Params>());
  gtsam::Values out = optimizer.optimize();
  std::cout << "iterations " << optimizer.iterations() << '\n';
  return out;
}

void write(const std::string& file, const gtsam::Values& poses, bool spatial) {
  std::ofstream out(file);
  out.precision(std::numeric_limits<double>::max_digits10);
  for (const gtsam::Key key : poses.keys()) {
    if (spatial) {
      const gtsam::Pose3& pose = poses.at<gtsam::Pose3>(key);
      const gtsam::Quaternion q = pose.rotation().toQuaternion();
      out << "VERTEX_SE3:QUAT " << key << ' ' << pose.x() << ' ' << pose.y() << ' ' << pose.z()
          << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
    } else {
      const gtsam::Pose2& pose = poses.at<gtsam::Pose2>(key);
      out << "VERTEX_SE2 " << key << ' ' << pose.x() << ' ' << pose.y() << ' ' << pose.theta()
          << '\n';
    }
  }
}

void run(const std::string& method, const std::string& file, const std::string& result) {
  const bool spatial = is_spatial(file);
  auto [graph, initial] = gtsam::readG2o(file, spatial);
  const gtsam::Key first = initial->keys().front();
  const gtsam::SharedNoiseModel gauge = gtsam::noiseModel::Isotropic::Sigma(spatial ? 6 : 3, 1e-3);
  if (spatial) {
    graph->addPrior(first, initial->at<gtsam::Pose3>(first), gauge);
  } else {
    graph->addPrior(first, initial->at<gtsam::Pose2>(first), gauge);
  }
  const auto begin = std::chrono::steady_clock::now();
  gtsam::Values start = *initial;
  if (method == "start") {
    start = spatial ? gtsam::InitializePose3::initialize(*graph) : gtsam::lago::initialize(*graph);
  }
  const gtsam::Values poses =
      method == "lm"
          ? optimized<gtsam::LevenbergMarquardtOptimizer, gtsam::LevenbergMarquardtParams>(*graph,
                                                                                           start)
          : optimized<gtsam::GaussNewtonOptimizer, gtsam::GaussNewtonParams>(*graph, start);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::cout << "seconds " << seconds.count() << '\n';
  write(result, poses, spatial);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string method = argc == 4 ? argv[1] : "";
  if (method != "gn" && method != "lm" && method != "start") {
    std::cerr << "usage: gtsam_pose_graph gn|lm|start GRAPH RESULT\n";
    return 2;
  }
  try {
    run(method, argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::cerr << "gtsam_pose_graph: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
