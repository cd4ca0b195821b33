#include <cmath>
#include <functional>

#include "datasets/core/mirrored.hpp"
#include "tests/metrics/doctor_pairs.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::doctor_closure_axes_test {
namespace {

/// A walk with closures over `span` keyframes, each `measured(true pose, first keyframe)`.
template <class Measured>
Problem walk_with_closures(std::size_t span, Measured measured) {
  Problem out = walk(5, 120, 0.01);
  out.closures.clear();
  for (std::size_t i = 0; i + span < 120; i += span / 10) {
    const Pose loop =
        out.keyframes[i].world_from_body.inverse() * out.keyframes[i + span].world_from_body;
    out.closures.push_back({i, i + span, measured(loop, i), out.odometry[0].information});
  }
  return out;
}

struct Change {
  const char* name;
  std::function<Pose(const Pose&)> of_closure;
  std::vector<Fault::Name> faults;
};

TEST(DoctorOfClosures, ConventionsOfClosures) {
  const Change changes[] = {
      {"none", [](const Pose& p) { return p; }, {}},
      {"left-handed axes",
       [](const Pose& p) { return mirrored(p, 1); },
       {Fault::closure_convention}},
      // Readers turn a loop around whose first stamp is the later one.
      {"misread rotations of loops from the later pose",
       [](const Pose& p) { return misordered(p.inverse()).inverse(); },
       {Fault::closure_convention}},
  };
  for (const Change& change : changes) {
    const auto measured = [&](const Pose& p, std::size_t) { return change.of_closure(p); };
    EXPECT_EQ(closure_faults(walk_with_closures(40, measured)), change.faults) << change.name;
  }
}

TEST(DoctorOfClosures, NamesTheAxesOfAnotherBody) {
  const Pose body{Rotation(Matrix3{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}), Vector3::Zero()};
  const Problem problem = walk_with_closures(40, [&](const Pose& loop, std::size_t i) {
    const Twist noise = 0.01 * twist({std::sin(7.0 * double(i)), 0, 1}, {0, 1, 0});
    return body.inverse() * (loop * exp_se3(noise)) * body;
  });
  const InputFinding found = only(check_closures(problem), Fault::closure_convention);
  EXPECT_THAT(found.evidence, HasSubstr("taking z,-x,-y as x,y,z in the body of the closures"));
}

/// A place recogniser without registration states the identity.
TEST(DoctorOfClosures, WithoutMeasuredPoses) {
  const Problem problem = walk_with_closures(60, [](const Pose&, std::size_t) { return Pose{}; });
  const InputFinding found = only(check_closures(problem), Fault::placeholders);
  EXPECT_THAT(found.evidence, HasSubstr("10 of 10 closures state exactly the same pose"));
}

TEST(DoctorOfClosures, InvertedRotations) {
  const Problem good = walk(5, 120, 0.01);
  EXPECT_THAT(check_closures(good), IsEmpty());
  Problem rotated = good;
  for (Edge& edge : rotated.closures) edge.from_from_to = conjugated(edge.from_from_to);
  only(check_closures(rotated), Fault::closure_convention);
}

}  // namespace
}  // namespace loopbench::test::doctor_closure_axes_test
