/// A simulated pair of trajectories for tests of `doctor`.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::test {

using namespace metrics;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A path through space with varied speed and rotation about all axes.
inline Pose at(double t) {
  const Vector3 phi(0.5 * std::sin(0.9 * t), 0.4 * std::cos(1.3 * t), 0.6 * t);
  return {exp_so3({0, 0, phi.z()}) * exp_so3({phi.x(), phi.y(), 0}),
          {4 * std::cos(0.6 * t + 0.2 * std::sin(t)), 3 * std::sin(0.6 * t), std::sin(0.35 * t)}};
}

inline Trajectory sampled(double rate, double offset = 0.0) {
  // Small errors that a tracker makes; in another world and body frame.
  const Pose world{exp_so3({0.1, -0.2, 1.0}), {5, 6, 7}};
  const Pose body{exp_so3({0.1, 0.05, -0.1}), Vector3::Zero()};
  Trajectory out;
  for (double t = 1.0; t < 40.0; t += 1.0 / rate) {
    const Pose error{exp_so3(0.004 * Vector3(std::sin(31 * t), std::cos(47 * t), std::sin(23 * t))),
                     0.004 * Vector3(std::cos(29 * t), std::sin(37 * t), std::sin(41 * t))};
    out.push_back({t - offset, normalized(world * at(t) * error * body)});
  }
  return out;
}

inline const Trajectory& truth() {
  static const Trajectory out = [] {
    Trajectory poses;
    for (double t = 0.0; t < 41.0; t += 0.01) poses.push_back({t, at(t)});
    return poses;
  }();
  return out;
}

template <class Change>
Trajectory each(Trajectory poses, Change change) {
  for (auto& [stamp, pose] : poses) pose = change(pose);
  return poses;
}

/// The only finding, which must be of that fault.
inline InputFinding only(const std::vector<InputFinding>& found, Fault::Name fault) {
  EXPECT_EQ(found.size(), 1u);
  if (found.empty()) return {};
  EXPECT_EQ(found[0].fault, fault) << text(found[0]);
  return found[0];
}

inline InputFinding only_finding(const Trajectory& reference,
                                 const Trajectory& estimate,
                                 Fault::Name fault) {
  return only(diagnosis(reference, estimate, "reference.txt", "run.txt").findings, fault);
}

/// A quaternion whose components were read in the order z w x y.
inline Pose misordered(const Pose& p) {
  return {Rotation(p.rotation.z(), p.rotation.w(), p.rotation.x(), p.rotation.y()), p.translation};
}

inline Pose conjugated(const Pose& p) { return {p.rotation.conjugate(), p.translation}; }

inline std::vector<Fault::Name> faults(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<Fault::Name> out;
  for (const InputFinding& finding :
       diagnosis(reference, estimate, "reference.txt", "run.txt").findings) {
    EXPECT_GT(finding.confidence, 0.0) << text(finding);
    EXPECT_LE(finding.confidence, 1.0) << text(finding);
    out.push_back(finding.fault);
  }
  return out;
}

inline std::vector<Fault::Name> closure_faults(const Problem& problem) {
  std::vector<Fault::Name> out;
  for (const InputFinding& finding : check_closures(problem)) out.push_back(finding.fault);
  return out;
}

}  // namespace loopbench::test
