/// Loop closures: of files, measured in a run, and false ones.
#include "datasets/derive/closures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "datasets/dataset.hpp"
#include "datasets/derive/false_closures.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/noise/random.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::closures_test {
namespace {

using testing::HasSubstr;

constexpr ClosureNoise kNoise = {0.5, 0.25};

std::string why_not_read(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.file("closures.txt", content);
  return refusal_of([&] { read_closure_file(file, kNoise); });
}

TEST(ClosureFile, IsReadByColumns) {
  const TemporaryFolder folder;
  const auto file = folder.file("closures.txt",
                                "# from to pose\n\n"
                                "1.5 9.25 1 2 3 0 0 0.6 0.8\n"
                                "2 8 0 0 0 0 0 0 1 0.1 0.2\n");
  const auto closures = read_closure_file(file, kNoise);
  ASSERT_EQ(closures.size(), 2u);
  EXPECT_EQ(closures[0].stamp_from, 1.5);
  EXPECT_EQ(closures[0].stamp_to, 9.25);
  EXPECT_EQ(closures[0].from_from_to.translation, Vector3(1.0, 2.0, 3.0));
  EXPECT_NEAR(closures[0].from_from_to.rotation.z(), 0.6, 1e-15);
  EXPECT_NEAR(closures[0].from_from_to.rotation.w(), 0.8, 1e-15);
  EXPECT_EQ(closures[0].noise.sigma_t, 0.5);
  EXPECT_EQ(closures[0].line, 3u);
  EXPECT_EQ(closures[1].noise.sigma_t, 0.1);
  EXPECT_EQ(closures[1].noise.sigma_r, 0.2);
}

TEST(ClosureFile, RefusalsNameFileAndLine) {
  EXPECT_THAT(why_not_read("# one\n1 2 3\n"), HasSubstr("closures.txt:2: "));
  EXPECT_THAT(why_not_read("1 2 3\n"), HasSubstr("9 or 11"));
  EXPECT_THAT(why_not_read("1 2 0 0 0 0 0 0 1 0.1\n"), HasSubstr("10 columns"));
  EXPECT_THAT(why_not_read("1 2 0 0 zero 0 0 0 1\n"), HasSubstr("(translation): 'zero'"));
  EXPECT_THAT(why_not_read("1 2 0 0 nan 0 0 0 1\n"), HasSubstr("closures.txt:1: "));
  EXPECT_THAT(why_not_read("1 2 0 0 0 0 0 0 2\n"), HasSubstr("closures.txt:1: "));
  EXPECT_THAT(why_not_read("1 2 0 0 0 0 0 0 1 0.1 0\n"), HasSubstr("sigma_r 0"));
  EXPECT_THAT(refusal_of([] { read_closure_file("absent.txt", kNoise); }), HasSubstr("absent.txt"));
}

TEST(ClosureFile, BecomesEdgesBetweenNearestPosesInOrder) {
  const Trajectory poses = on_a_line({0, 1, 2, 3, 4});
  const Pose pose{exp_so3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const std::vector<StampedClosure> closures = {{1.01, 4.0, pose, kNoise, 1},
                                                {3.0, 0.0, pose, kNoise, 2}};
  const auto edges = as_edges(closures, poses, 0.02, "f");
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[0].from, 0u);
  EXPECT_EQ(edges[0].to, 3u);
  EXPECT_POSE_NEAR(edges[0].from_from_to, pose.inverse(), 1e-12, 1e-12);
  EXPECT_EQ(edges[1].from, 1u);
  EXPECT_EQ(edges[1].to, 4u);
  EXPECT_EQ(edges[1].information, isotropic_information(0.25, 0.0625));
}

TEST(ClosureFile, TurnedRoundKeepsWhatANoiseMeans) {
  // The same error has the same cost for the edge and its inverse.
  const Trajectory poses = on_a_line({0, 1});
  const Pose pose{exp_so3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const auto edges = as_edges({{1.0, 0.0, pose, {0.1, 0.3}, 1}}, poses, 0.02, "f");
  const Twist error = twist({1e-6, 2e-6, -1e-6}, {3e-6, -1e-6, 2e-6});
  const Matrix6 information = isotropic_information(0.01, 0.09);
  const Twist turned = log_se3(edges[0].from_from_to.inverse() * (pose * exp_se3(error)).inverse());
  EXPECT_NEAR(
      turned.dot(edges[0].information * turned) / error.dot(information * error), 1.0, 1e-5);
}

TEST(ClosureFile, NamesTheStampThatNoPoseHas) {
  const Trajectory poses = on_a_line({0, 1, 2});
  EXPECT_THAT(refusal_of([&] {
                as_edges({{0.0, 1.5, {}, kNoise, 7}}, poses, 0.02, "loops.txt");
              }),
              HasSubstr("loops.txt:7: found stamp 1.5"));
  EXPECT_THAT(refusal_of([&] {
                as_edges({{1.0, 1.01, {}, kNoise, 8}}, poses, 0.02, "loops.txt");
              }),
              HasSubstr("loops.txt:8: "));
}

TEST(PosesAt, InterpolateOverShortGapsOnly) {
  Trajectory run = on_a_line({0.0, 1.0, 2.0}, 0.1);
  run.push_back({1.0, {Rotation::Identity(), {9.0, 0.0, 0.0}}});
  const auto poses = poses_at(run, {0.05, 0.2, 0.21, 0.5, 0.99, 1.01, 1.5, -0.01, -1.0}, {});
  ASSERT_EQ(poses.size(), 9u);
  EXPECT_NEAR(poses[0]->translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(poses[1]->translation.x(), 2.0, 1e-12);
  EXPECT_NEAR(poses[2]->translation.x(), 2.0, 1e-12);  // nearest, 0.01 s away
  EXPECT_FALSE(poses[3]);                              // in a gap
  EXPECT_EQ(poses[4]->translation.x(), 9.0);
  EXPECT_EQ(poses[5]->translation.x(), 9.0);
  EXPECT_FALSE(poses[6]);
  EXPECT_EQ(poses[7]->translation.x(), 0.0);
  EXPECT_FALSE(poses[8]);
  EXPECT_FALSE(poses_at({}, {0.0}, {})[0]);
}

TEST(PosesAt, NearestPrefersTheEarlierOfEquals) {
  const Trajectory run = on_a_line({0.0, 1.0});
  EXPECT_EQ(nearest_pose(run, 0.5, 0.5), 0u);
  EXPECT_EQ(nearest_pose(run, 0.6, 0.5), 1u);
  EXPECT_EQ(nearest_pose(run, 2.0, 0.5), std::nullopt);
}

/// Two rounds on a circle with radius 2 m in 20 s, looking forward.
Trajectory two_rounds(std::size_t size) {
  Trajectory out;
  for (std::size_t i = 0; i < size; ++i) {
    const double time = 20.0 * static_cast<double>(i) / static_cast<double>(size - 1);
    const double angle = 4.0 * M_PI * time / 20.0;
    out.push_back(
        {time, {exp_so3({0.0, 0.0, angle}), {2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0}}});
  }
  return out;
}

TEST(MeasuredClosures, AreTheRunsOwnRelativePoses) {
  const Trajectory run = two_rounds(401);
  Trajectory keyframes;
  for (std::size_t i = 0; i < run.size(); i += 8) {  // every 0.4 s, with drift
    const Pose drift = exp_se3(twist({0.0, 0.0, 0.01 * static_cast<double>(i)}, Vector3::Zero()));
    keyframes.push_back({run[i].stamp, drift * run[i].world_from_body});
  }
  const auto closures = measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 0, {}, {});
  ASSERT_EQ(closures.size(), 26u);  // all keyframes of the second round: 10 s to 20 s
  for (const Edge& closure : closures) {
    EXPECT_EQ(closure.to - closure.from, 25u);
    EXPECT_POSE_NEAR(closure.from_from_to, {}, 1e-9, 1e-9);
    EXPECT_NEAR(closure.information(0, 0), 1.0 / (0.02 * 0.02), 1e-9);
    EXPECT_NEAR(closure.information(3, 3), 1.0 / (0.01 * 0.01), 1e-9);
  }
  EXPECT_EQ(measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 4, {}, {}).size(), 4u);
}

TEST(MeasuredClosures, SkipKeyframesTheRunDoesNotKnow) {
  const Trajectory keyframes = two_rounds(51);
  Trajectory run = two_rounds(401);
  run.resize(301);  // no poses after 15 s
  const auto closures = measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 0, {}, {});
  ASSERT_FALSE(closures.empty());
  EXPECT_LE(keyframes[closures.back().to].stamp, 15.02);
}

TEST(MeasuredClosures, NoiseHasTheStatedSizeAndSeed) {
  const std::vector<Edge> exact(20000, Edge{0, 1, {}, Matrix6::Identity()});
  const auto noisy = with_noise(exact, {0.05, 0.02}, {7});
  Twist variance = Twist::Zero();
  for (const Edge& edge : noisy) {
    variance += log_se3(edge.from_from_to).cwiseAbs2() / static_cast<double>(noisy.size());
  }
  // Relative standard error of a variance: sqrt(2 / 20000) = 0.01.
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(std::sqrt(variance[i]) / (i < 3 ? 0.05 : 0.02), 1.0, 0.02);
  const auto again = with_noise(exact, {0.05, 0.02}, {7});
  const auto other = with_noise(exact, {0.05, 0.02}, {8});
  EXPECT_EQ(noisy[99].from_from_to.translation, again[99].from_from_to.translation);
  EXPECT_NE(noisy[99].from_from_to.translation, other[99].from_from_to.translation);
}

TEST(MeasuredClosures, PathRatioShowsAnotherScale) {
  const Trajectory keyframes = two_rounds(51);
  Trajectory run = two_rounds(401);
  for (auto& [stamp, pose] : run) pose.translation *= 3.0;
  EXPECT_NEAR(path_length_ratio(keyframes, run, {}), 3.0, 1e-9);
  EXPECT_EQ(path_length_ratio(keyframes, {}, {}), 1.0);
}

TEST(MeasuredClosures, OfARunWithItsOwnUnitAreOfSim3) {
  // The run moves 3 m per step; the estimate 1 at first, and 0.5 from keyframe 30.
  Trajectory keyframes, run;
  double x = 0.0;
  for (int i = 0; i < 60; ++i) {
    keyframes.push_back({double(i), {Rotation::Identity(), Vector3(x, 0, 0)}});
    run.push_back({double(i), {Rotation::Identity(), Vector3(3.0 * i, 0, 0)}});
    x += i < 30 ? 1.0 : 0.5;
  }
  const Edge measured{10, 50, {Rotation::Identity(), Vector3(120, 0, 0)}, Matrix6::Identity()};
  const auto edges = with_local_scale({measured}, keyframes, run, {});
  EXPECT_NEAR(edges[0].scale, 6.0 / 3.0, 1e-12);
  EXPECT_NEAR(
      edges[0].from_from_to.translation.x(), 40.0, 1e-12);  // 120 m in the run, 3 m per unit
  Trajectory still = keyframes;
  for (auto& [stamp, pose] : still) pose = Pose{Rotation::Identity(), Vector3::Zero()};
  EXPECT_THROW(with_local_scale({measured}, still, run, {}), InputError);
}

Problem chain(std::size_t keyframes, std::size_t closures) {
  Problem out;
  out.keyframes = random_walk(keyframes, 3, 1.0, 0.1);
  for (std::size_t k = 0; k < closures; ++k) {
    out.closures.push_back({0, keyframes - 1, {}, Matrix6::Identity()});
  }
  return out;
}

TEST(FalseClosures, ShortChainsGetTheirShareToo) {
  for (const std::size_t keyframes : {3u, 4u, 10u, 39u, 40u, 200u}) {
    Problem problem = chain(keyframes, 6);
    EXPECT_EQ(add_false_closures(problem, {0.5, 1}, 0).size(), 6u) << keyframes;
    EXPECT_EQ(problem.closures.size(), 12u);
    for (const Edge& closure : problem.closures) {
      EXPECT_GE(closure.to - closure.from, std::max<std::size_t>(2, keyframes / 20));
    }
  }
  Problem two = chain(2, 1);
  EXPECT_THAT(refusal_of([&] {
                add_false_closures(two, {0.5, 1}, 0);
              }),
              HasSubstr("found 2 keyframes, expected at least 3"));
  EXPECT_TRUE(add_false_closures(two, {0.0, 1}, 0).empty());
}

TEST(FalseClosures, IndicesAreThoseOfTheAddedOnes) {
  Problem problem = chain(200, 6);  // all from the first to the last keyframe
  const std::vector<std::size_t> added = add_false_closures(problem, {0.5, 1}, 0);
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Edge& edge = problem.closures[k];
    if (edge.from != 0 || edge.to != 199) others.push_back(k);
  }
  EXPECT_EQ(added, others);
}

TEST(SortClosures, MarksFollowTheirClosures) {
  std::vector<Edge> closures{{1, 9, {}}, {0, 5, {}}, {0, 9, {}}, {0, 5, {}}};
  std::vector<std::size_t> marked{0, 3};
  sort_closures(closures, &marked);  // 0-5, 0-5 (marked), 0-9, 1-9 (marked)
  EXPECT_EQ(marked, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(closures[3].from, 1u);
}

TEST(FalseClosures, IdentitiesDrawIndependently) {
  Problem a = chain(200, 20), b = a, c = a;
  add_false_closures(a, {0.5, 1}, 1);
  add_false_closures(b, {0.5, 1}, 1);
  add_false_closures(c, {0.5, 1}, 2);
  const auto ends = [](const Problem& problem) {
    std::vector<std::size_t> out;
    for (const Edge& edge : problem.closures) out.push_back(edge.from);
    return out;
  };
  EXPECT_EQ(ends(a), ends(b));
  EXPECT_NE(ends(a), ends(c));
}

TEST(FalseClosures, ProvenanceCountsWhatWasAdded) {
  const TemporaryFolder folder;
  std::string poses;
  for (int i = 0; i <= 12; ++i) {
    poses += std::to_string(i) + " " + std::to_string(i % 6) + " 0 0 0 0 0 1\n";
  }
  folder.file("est.txt", poses);
  folder.file("loops.txt", "0 12 0 0 0 0 0 0 1\n1 7 0 0 0 0 0 0 1\n2 8 0 0 0 0 0 0 1\n");
  const auto closures = [&](double share) {
    return load_dataset("trajectory",
                        {{"estimate", "est.txt"},
                         {"closures.source", "file"},
                         {"closures.file", "loops.txt"},
                         {"false_closures.share", share}},
                        {{folder.path()}})
        .provenance.closures;
  };
  EXPECT_EQ(closures(0.0), "file: loops.txt (3)");
  EXPECT_EQ(closures(0.5), "file: loops.txt (6), 3 of 6 false and added");
  EXPECT_EQ(closures(0.1),
            "file: loops.txt (3), 0 of 3 false and added");  // 1/3 closure, rounded to 0
}

}  // namespace
}  // namespace loopbench::closures_test
