/// Runs a corrector; counts that methods report; distances between trajectories.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "methods/correctors/chain.hpp"
#include "methods/method.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test {

using namespace methods;

/// Keyframes corrected by `Method`.
template <class Method>
Trajectory corrected(const Problem& problem,
                     const typename Method::Options& options = {},
                     Report* report = nullptr) {
  Report unused;
  return Method(options).correct(problem, report ? *report : unused);
}

/// The count of that name: iterations, kinks, segments ...; fails the test if there is none.
inline double count(const Report& report, const std::string& name) {
  for (const Count& each : report.counts) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << "no count " << name;
  return std::nan("");
}

inline std::vector<Pose> poses_of(const Trajectory& trajectory) {
  std::vector<Pose> out;
  for (const StampedPose& each : trajectory) out.push_back(each.world_from_body);
  return out;
}

/// Half of chi^2 of odometry and closures.
inline double chain_cost(const Problem& problem, const std::vector<Pose>& poses) {
  double sum = 0.0;
  for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (const Edge& edge : *edges) {
      const Twist e = edge_error(edge, poses[edge.from], poses[edge.to]);
      sum += e.dot(edge.information * e);
    }
  }
  return 0.5 * sum;
}

/// Distances between the positions of two trajectories with the same stamps, not aligned [m].
inline std::vector<double> distances(const Trajectory& a, const Trajectory& b) {
  std::vector<double> out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    out.push_back((a[i].world_from_body.translation - b[i].world_from_body.translation).norm());
  }
  return out;
}

inline double largest_distance(const Trajectory& a, const Trajectory& b) {
  return std::ranges::max(distances(a, b));
}

/// Root mean square of distances() [m].
inline double rmse(const Trajectory& a, const Trajectory& b) {
  double sum = 0.0;
  for (const double each : distances(a, b)) sum += each * each;
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// The poses of `reference` that are nearest to the stamps of `keyframes`, at most 1 us earlier.
inline Trajectory at_stamps_of(const Trajectory& keyframes, const Trajectory& reference) {
  Trajectory out;
  std::size_t j = 0;
  for (const StampedPose& keyframe : keyframes) {
    while (j + 1 < reference.size() && reference[j].stamp < keyframe.stamp - 1e-6) ++j;
    out.push_back(reference[j]);
  }
  return out;
}

inline void expect_close(const Trajectory& a, const Trajectory& b, double metres, double radians) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pose& p = a[i].world_from_body;
    const Pose& q = b[i].world_from_body;
    EXPECT_POSE_NEAR(p, q, metres, radians)
        << "pose " << i << " at " << a[i].stamp << " s: " << (p.translation - q.translation).norm()
        << " m, " << angle_between(p.rotation, q.rotation) << " rad";
  }
}

/// Expects equal poses up to the tolerance, in [m] and [rad].
inline void expect_close(const Trajectory& a, const Trajectory& b, double tolerance) {
  expect_close(a, b, tolerance, tolerance);
}

/// Expects positions on the x axis [m].
inline void expect_positions(const Trajectory& poses,
                             const std::vector<double>& x,
                             double tolerance = 1e-12) {
  ASSERT_EQ(poses.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(poses[i].world_from_body.translation.x(), x[i], tolerance) << i;
    EXPECT_NEAR(poses[i].world_from_body.translation.tail<2>().norm(), 0.0, tolerance) << i;
  }
}

/// Error of the loop on the trajectory, [m] + [rad].
inline double closing_error(const Edge& loop, const Trajectory& poses) {
  const Pose target = poses[loop.from].world_from_body * loop.from_from_to;
  const Pose& end = poses[loop.to].world_from_body;
  return (target.translation - end.translation).norm() +
         angle_between(target.rotation, end.rotation);
}

/// Expects that the cost rises in all directions from the poses, with zero slope; the first pose is
/// fixed.
inline void expect_minimum(const Problem& problem, const std::vector<Pose>& poses) {
  const double minimum = chain_cost(problem, poses);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    for (int d = 0; d < 6; ++d) {
      const auto cost = [&](double step) {
        std::vector<Pose> moved = poses;
        moved[i] = poses[i] * exp_se3(step * Twist::Unit(d));
        return chain_cost(problem, moved);
      };
      EXPECT_NEAR((cost(1e-5) - cost(-1e-5)) / 2e-5, 0.0, 1e-4) << i << " " << d;
      EXPECT_GT(cost(1e-5), minimum) << i << " " << d;
    }
  }
}

}  // namespace loopbench::test
