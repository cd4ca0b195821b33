/// Small problems for tests of methods, with known path, drift and closures.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/params.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench::test {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Odometry = true steps * exp(bias), keyframes = odometry chained from the true start,
/// exact closures.
inline Problem drifting(const Trajectory& truth, const Twist& bias, const Pairs& closures) {
  Problem out;
  const auto between = [&](std::size_t from, std::size_t to) {
    return truth[from].world_from_body.inverse() * truth[to].world_from_body;
  };
  Matrix6 information = Matrix6::Identity();
  information.diagonal() << 100.0, 100.0, 400.0, 2500.0, 2500.0, 1e4;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i == 0) {
      out.keyframes.push_back(truth[0]);
      continue;
    }
    const Pose step = normalized(between(i - 1, i) * exp_se3(bias));
    out.odometry.push_back({i - 1, i, step, information});
    out.keyframes.push_back(
        {truth[i].stamp, normalized(out.keyframes.back().world_from_body * step)});
  }
  for (const auto& [from, to] : closures) {
    out.closures.push_back({from, to, normalized(between(from, to)), 4.0 * information});
  }
  return out;
}

/// `count` tracked frames between neighbouring keyframes, slightly off the line between them.
inline void add_frames(Problem& problem, int count) {
  for (std::size_t i = 0; i + 1 < problem.keyframes.size(); ++i) {
    const auto& [begin, a] = problem.keyframes[i];
    const auto& [end, b] = problem.keyframes[i + 1];
    for (int k = 1; k <= count; ++k) {
      const double u = k / (count + 1.0);
      Pose pose = interpolate(a, b, u);
      pose.translation += 0.004 * std::sin(std::numbers::pi * u) * Vector3(1.0, -0.5, 0.3);
      problem.frames.push_back({begin + u * (end - begin), pose});
    }
  }
}

/// Times of all keyframes, and `between` evenly spaced times in every interval.
inline std::vector<double> query_times(const Trajectory& keyframes, int between = 3) {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
    const double step = (keyframes[i + 1].stamp - keyframes[i].stamp) / (between + 1);
    for (int k = 0; k <= between; ++k) out.push_back(keyframes[i].stamp + k * step);
  }
  if (!keyframes.empty()) out.push_back(keyframes.back().stamp);
  return out;
}

inline Pose at_x(double x) { return {Rotation::Identity(), {x, 0.0, 0.0}}; }

/// Keyframes at the given positions along x [m], a second apart by default, and the exact odometry
/// between them with unit information.
inline Problem along_x(const std::vector<double>& positions,
                       const std::vector<double>& times = {}) {
  Problem out;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double stamp = times.empty() ? static_cast<double>(i) : times[i];
    out.keyframes.push_back({stamp, at_x(positions[i])});
    if (i > 0) out.odometry.push_back({i - 1, i, at_x(positions[i] - positions[i - 1])});
  }
  return out;
}

inline Pose turned_about_z(double yaw, const Vector3& place) {
  return {exp_so3({0.0, 0.0, yaw}), place};
}

/// One round on a circle of 5 m, a keyframe every 0.5 s, with a yaw drift of `bias` per keyframe.
inline Problem circle(std::size_t n = 41, double bias = 0.01) {
  Trajectory truth;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n - 1);
    truth.push_back({0.5 * static_cast<double>(i),
                     turned_about_z(angle, 5.0 * Vector3(std::cos(angle), std::sin(angle), 0.0))});
  }
  return drifting(
      truth, twist({0.0, 0.0, 0.002}, {0.0, 0.0, bias}), n > 1 ? Pairs{{0, n - 1}} : Pairs{});
}

/// Stamps 0.1 to 0.7 s apart.
inline std::vector<double> uneven(std::size_t n, double begin = 0.0) {
  std::vector<double> out;
  double time = begin;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(time);
    time += 0.1 + 0.6 * std::pow(std::sin(1.7 * static_cast<double>(i)), 2);
  }
  return out;
}

/// The poses of the path `truth` at the stamps.
template <class Truth>
Trajectory sampled_at(const std::vector<double>& stamps, Truth truth) {
  Trajectory out;
  for (const double stamp : stamps) out.push_back({stamp, truth(stamp)});
  return out;
}

/// A hand-held loop through a room with motion in all six dimensions, keyframes 0.1 to 0.7 s apart.
inline Trajectory hand_held_truth(std::size_t n = 60) {
  return sampled_at(uneven(n, 100.0), [](double time) {
    const double s = 0.11 * (time - 100.0);
    return Pose{exp_so3({0.3 * std::sin(3.0 * s), 0.2 * std::cos(2.0 * s), 2.0 * s}),
                {2.0 * std::cos(2.0 * s), 1.5 * std::sin(2.0 * s), 0.4 * std::sin(5.0 * s)}};
  });
}

/// Two overlapping loops, frames between the keyframes, and drift in all six dimensions.
inline Problem hand_held() {
  Problem out = drifting(hand_held_truth(),
                         twist({0.004, -0.003, 0.002}, {0.002, -0.001, 0.004}),
                         {{2, 40}, {20, 57}});
  add_frames(out, 3);
  return out;
}

/// The same path without any error.
inline Problem perfect() { return drifting(hand_held_truth(), Twist::Zero(), {{2, 40}, {20, 57}}); }

/// A planar figure of eight, measured in SE(2), with closures at the crossing and the start.
inline Problem planar() {
  Trajectory truth;
  for (std::size_t i = 0; i < 49; ++i) {
    const double s = 2.0 * std::numbers::pi * static_cast<double>(i) / 48.0;
    const Vector3 speed(4.0 * std::cos(s), 4.0 * std::cos(2.0 * s), 0.0);
    truth.push_back({0.25 * static_cast<double>(i),
                     turned_about_z(std::atan2(speed.y(), speed.x()),
                                    {4.0 * std::sin(s), 2.0 * std::sin(2.0 * s), 0.0})});
  }
  Problem out = drifting(truth, twist({0.003, 0.002, 0.0}, {0.0, 0.0, 0.006}), {{0, 24}, {0, 48}});
  out.planar = true;
  return out;
}

/// Straight motion at 0.8 m/s without rotation, uneven stamps; a closure from start to end.
inline Problem straight() {
  Trajectory truth;
  double time = 0.0;
  for (std::size_t i = 0; i < 30; ++i) {
    truth.push_back({time,
                     {exp_so3({0.1, -0.2, 0.7}),
                      Vector3(1.0, 2.0, -0.5) + 0.8 * time * Vector3(2.0, -1.0, 2.0) / 3.0}});
    time += i % 3 == 0 ? 0.2 : 0.5;
  }
  return drifting(truth, Twist::Zero(), {{0, 29}});
}

/// The camera does not move at all.
inline Problem standing() {
  Trajectory truth(20);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i] = {0.3 * static_cast<double>(i), {exp_so3({0.4, 0.0, 1.0}), {1.0, 2.0, 3.0}}};
  }
  return drifting(truth, Twist::Zero(), {{0, 19}});
}

/// The camera rotates in place at a slightly uneven rate; the rotation is measured with an error.
inline Problem spinning() {
  Trajectory truth(25);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double s = static_cast<double>(i);
    truth[i] = {0.3 * s, turned_about_z(0.26 * s + 0.05 * std::sin(s), {1.0, 2.0, 3.0})};
  }
  return drifting(truth, twist({0.0, 0.0, 0.0}, {0.001, 0.0, 0.003}), {{0, 24}});
}

/// The first `n` keyframes of the circle and their edges; with a closure for two or more.
inline Problem short_circle(std::size_t n) {
  Problem out = circle(41);
  out.keyframes.resize(n);
  out.odometry.resize(n > 0 ? n - 1 : 0);
  out.closures.clear();
  if (n > 1) {
    Edge edge{0, n - 1, out.keyframes[n - 1].world_from_body, Matrix6::Identity()};
    edge.from_from_to = out.keyframes[0].world_from_body.inverse() * edge.from_from_to;
    edge.from_from_to.translation.x() += 0.05;
    out.closures.push_back(edge);
  }
  return out;
}

inline Problem with_closures(Problem problem, const Trajectory& truth, const Pairs& pairs) {
  problem.closures = drifting(truth, Twist::Zero(), pairs).closures;
  return problem;
}

/// The same problem in another world frame.
inline Problem moved_by(const Pose& there_from_here, Problem problem) {
  for (Trajectory* part : {&problem.keyframes, &problem.frames}) {
    for (StampedPose& pose : *part) {
      pose.world_from_body = normalized(there_from_here * pose.world_from_body);
    }
  }
  for (Anchor& anchor : problem.anchors) {
    const Matrix3 R = there_from_here.rotation.toRotationMatrix();
    anchor.position = there_from_here * anchor.position;
    anchor.covariance = R * anchor.covariance * R.transpose();
  }
  return problem;
}

/// The problem with anchors at four keyframes, `error` [m] away from its keyframes.
inline Problem with_anchors(Problem problem, const Vector3& error) {
  const std::size_t last = problem.keyframes.size() - 1;
  Matrix3 covariance = 1e-4 * Matrix3::Identity();
  covariance(0, 1) = covariance(1, 0) = 3e-5;
  for (const std::size_t i : {std::size_t{0}, last / 4, last / 2, last}) {
    const Vector3& at = problem.keyframes[i].world_from_body.translation;
    problem.anchors.push_back({i, at + (i == last ? 2.0 : 1.0) * error, covariance});
  }
  return problem;
}

struct NamedProblem {
  std::string name;
  Problem problem;
};

/// Problems that every method should correct.
inline std::vector<NamedProblem> ordinary_problems() {
  return {{"circle", circle()}, {"hand_held", hand_held()}, {"planar", planar()}};
}

/// Degenerate problems, which a method may decline but on which it must not fail.
inline std::vector<NamedProblem> awkward_problems() {
  const Trajectory truth = hand_held_truth();
  const Problem base = hand_held();
  Problem bare = base;
  bare.odometry.clear();
  return {{"no keyframes", short_circle(0)},
          {"one keyframe", short_circle(1)},
          {"two keyframes", short_circle(2)},
          {"three keyframes", short_circle(3)},
          {"no closures", with_closures(base, truth, {})},
          {"overlapping closures", with_closures(base, truth, {{0, 30}, {10, 45}, {5, 50}})},
          {"nested closures", with_closures(base, truth, {{20, 30}, {10, 40}, {0, 59}})},
          {"duplicate closures", with_closures(base, truth, {{5, 40}, {5, 40}, {6, 40}})},
          {"neighbours closed", with_closures(base, truth, {{7, 8}})},
          {"no odometry edges", bare},
          {"straight line", straight()},
          {"standing still", standing()},
          {"pure rotation", spinning()}};
}

}  // namespace loopbench::test
