/// Inputs of the guard of ratios: files of two trajectories, and a simulated pose graph.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <utility>

#include "datasets/core/problem.hpp"

namespace loopbench::test {

/// Positions at a time [s] for which checks of inputs had different costs.
using Motion = std::function<Vector3(double)>;
inline std::vector<std::pair<std::string, Motion>> motions() {
  const auto walk = [](double t) {  // sums of sines without a common period
    return Vector3(30.0 * std::sin(0.011 * t) + 3.0 * std::sin(0.17 * t),
                   20.0 * std::sin(0.013 * t + 1.0) + 2.0 * std::sin(0.23 * t),
                   std::sin(0.05 * t));
  };
  return {{"constant speed", [](double t) { return Vector3(10.0 * t, std::sin(0.02 * t), 0.0); }},
          {"standstill", [](double) { return Vector3(1.0, 2.0, 0.0); }},
          {"straight line", [](double t) { return Vector3(5.0 * t + std::sin(0.3 * t), 0, 0); }},
          {"circle",
           [](double t) { return Vector3(20 * std::cos(0.1 * t), 20 * std::sin(0.1 * t), 0); }},
          {"random walk", nullptr},
          {"no overlap", walk},
          {"another recording", walk}};
}

/// Writes a reference and an estimate with noise of 1 cm at 10 Hz, in the format of TUM.
inline void write_pair(const std::filesystem::path& folder,
                       const std::string& name,
                       const Motion& motion,
                       std::size_t poses) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::ofstream reference(folder / "reference.txt"), estimate(folder / "estimate.txt");
  Vector3 walked = Vector3::Zero();
  for (std::size_t i = 0; i < poses; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    walked += 0.1 * Vector3(noise(random), noise(random), 0.1 * noise(random));
    const Vector3 p = motion ? motion(t) : walked;
    const bool is_other = name == "another recording";
    const Vector3 q = (is_other ? motion(0.7 * t + 100.0) : p) +
                      0.01 * Vector3(noise(random), noise(random), noise(random));
    const double angle = 0.5 * 0.05 * t;
    const double later = name == "no overlap" ? 1e6 : 0.0;
    const auto line = [&](std::ofstream& out, double stamp, const Vector3& at) {
      out << fmt::format("{:.6f} {:.9f} {:.9f} {:.9f} 0 0 {:.9f} {:.9f}\n",
                         stamp,
                         at.x(),
                         at.y(),
                         at.z(),
                         std::sin(angle),
                         std::cos(angle));
    };
    line(reference, t, p);
    line(estimate, t + later, q);
  }
}

/// A walk over a grid of streets like M3500: unit steps with turns of 90 degrees, and a loop
/// closure for more than half of the keyframes that return to a crossing or stand beside one seen
/// before.
inline Problem manhattan(std::size_t keyframes) {
  constexpr int kStreets = 40;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto pose = [](double x, double y, double yaw) {
    return Pose{Rotation(Eigen::AngleAxisd(yaw, Vector3::UnitZ())), {x, y, 0.0}};
  };
  Matrix6 information = Matrix6::Identity();
  information.diagonal() << 44.7, 44.7, 44.7, 44.7, 44.7, 44.7;
  std::vector<Pose> truth;
  Problem out;
  out.planar = true;
  const auto measured = [&](std::size_t from, std::size_t to) {
    return truth[from].inverse() * truth[to] *
           pose(0.1 * noise(random), 0.1 * noise(random), 0.05 * noise(random));
  };
  std::map<std::pair<int, int>, std::size_t> last;  // keyframe at each crossing
  int x = 0, y = 0, heading = 0;
  constexpr int kSteps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (std::size_t i = 0; i < keyframes; ++i) {
    truth.push_back(pose(x, y, M_PI_2 * heading));
    Pose start = truth.back();
    if (i > 0) {
      out.odometry.push_back({i - 1, i, measured(i - 1, i), information});
      start = out.keyframes.back().world_from_body * out.odometry.back().from_from_to;
      start.rotation.normalize();
    }
    out.keyframes.push_back({static_cast<double>(i), start});
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}}) {
      const auto seen = last.find({x + dx, y + dy});
      if (seen == last.end() || seen->second + 10 > i || random() % 3 == 0) continue;
      out.closures.push_back({seen->second, i, measured(seen->second, i), information});
      break;
    }
    last[{x, y}] = i;
    if (random() % 3 == 0) heading = (heading + (random() % 2 == 0 ? 1 : 3)) % 4;
    while (std::abs(x + kSteps[heading][0]) > kStreets / 2 ||
           std::abs(y + kSteps[heading][1]) > kStreets / 2)
      heading = (heading + 1) % 4;
    x += kSteps[heading][0];
    y += kSteps[heading][1];
  }
  return out;
}

}  // namespace loopbench::test
