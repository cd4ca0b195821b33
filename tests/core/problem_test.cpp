#include "datasets/core/problem.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/refusal_of.hpp"

namespace loopbench::problem_test {
namespace {

Edge edge(std::size_t from, std::size_t to) {
  Edge out;
  out.from = from;
  out.to = to;
  return out;
}

Problem square() {
  Problem out;
  out.keyframes.resize(4);
  for (std::size_t i = 0; i < 4; ++i) out.keyframes[i].stamp = static_cast<double>(i);
  out.odometry = {edge(0, 1), edge(1, 2), edge(2, 3)};
  out.closures = {edge(1, 2), edge(0, 3), edge(1, 3), edge(1, 3)};
  return out;
}

std::string refusal(const std::function<void(Problem&)>& spoil) {
  Problem problem = square();
  spoil(problem);
  return refusal_of<InputError>([&] { check(problem, "p"); });
}

TEST(Problem, CheckAcceptsGoodOnes) {
  EXPECT_EQ(refusal([](Problem&) {}), "");
  EXPECT_EQ(refusal([](Problem& p) { p = {}; }), "");
  EXPECT_EQ(refusal([](Problem& p) { p.odometry.erase(p.odometry.begin() + 1); }), "")
      << "a chain may have gaps";
}

TEST(Problem, CheckNamesTheTrajectory) {
  EXPECT_EQ(refusal([](Problem& p) { p.keyframes[2].stamp = 0.0; }),
            "p: keyframes: pose 2: stamp does not increase");
  EXPECT_EQ(refusal([](Problem& p) { p.frames.resize(2); }),
            "p: frames: pose 1: stamp does not increase");
}

TEST(Problem, CheckNamesTheEdgeAndTheRule) {
  EXPECT_EQ(refusal([](Problem& p) { p.closures[0] = edge(2, 2); }),
            "p: closure 0: from is not before to");
  EXPECT_EQ(refusal([](Problem& p) { p.closures[3].to = 4; }),
            "p: closure 3: refers to a keyframe that does not exist");
  EXPECT_EQ(refusal([](Problem& p) { p.odometry[1].from_from_to.translation.x() = std::nan(""); }),
            "p: odometry edge 1: is not finite");
  EXPECT_EQ(refusal([](Problem& p) { p.closures[1].scale = 0.0; }), "p: closure 1: is not finite");
  EXPECT_EQ(refusal([](Problem& p) { p.closures[1].from_from_to.rotation.w() = 2.0; }),
            "p: closure 1: quaternion is not unit");
  EXPECT_EQ(refusal([](Problem& p) { p.odometry[0].information(0, 1) = 0.5; }),
            "p: odometry edge 0: information is not symmetric");
  EXPECT_EQ(refusal([](Problem& p) { p.odometry[0].information(5, 5) = 0.0; }),
            "p: odometry edge 0: information is not positive definite");
}

TEST(Problem, CheckNamesTheOrder) {
  EXPECT_EQ(refusal([](Problem& p) { p.odometry[1].to = 3; }),
            "p: odometry edge 1: does not connect consecutive keyframes");
  EXPECT_EQ(refusal([](Problem& p) { p.odometry[1] = edge(0, 1); }),
            "p: odometry edge 1: is not sorted by from");
  EXPECT_EQ(refusal([](Problem& p) { std::swap(p.closures[0], p.closures[1]); }),
            "p: closure 1: is not sorted by (to, from)");
}

}  // namespace
}  // namespace loopbench::problem_test
