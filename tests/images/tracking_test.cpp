// Tests of the parts of tracking and loop detection against values computed by hand or theory.
#include <cmath>
#include <numbers>

#include "datasets/images/features/matching.hpp"
#include "datasets/images/frames/ordered_pipeline.hpp"
#include "datasets/images/loops/normalised_gap.hpp"
#include "datasets/images/loops/retrieval.hpp"
#include "datasets/images/loops/vocabulary.hpp"
#include "datasets/images/tracking/camera_pose.hpp"
#include "datasets/images/tracking/local_map.hpp"
#include "datasets/images/tracking/tracker.hpp"
#include "datasets/noise/random.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::tracking_test {

using namespace rgbd;

namespace {

const Pose kTruth{exp_so3({0.1, -0.2, 0.3}), {0.2, -0.1, 0.4}};

/// Error-free observations of points from a camera at kTruth; every `wrong`-th one is an outlier.
std::vector<Observation> observe(std::size_t count, std::size_t wrong) {
  Random random({5}, Purpose::odometry);
  const Camera camera;
  std::vector<Observation> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = 640.0 * random.uniform();
    const double v = 480.0 * random.uniform();
    const double z = 1.0 + 3.0 * random.uniform();
    Observation o{kTruth * camera.back_project(u, v, z), u, v, 1.0 / z, 1.0};
    if (wrong > 0 && i % wrong == 0) o.u = 640.0 * random.uniform();
    out.push_back(o);
  }
  return out;
}

TEST(CameraPose, IsFoundAmongOutliersAndThenExact) {
  const std::vector<Observation> all = observe(90, 3);
  const std::optional<Pose> found = pose_by_ransac(all, {});
  ASSERT_TRUE(found);
  EXPECT_POSE_NEAR(*found, kTruth, 0.02, 0.01);
  const RefinedPose refined = refine_pose(all, {}, *found);
  EXPECT_POSE_NEAR(refined.world_from_camera, kTruth, 1e-9, 1e-9);
  EXPECT_GE(refined.inliers, 60u);
  EXPECT_LE(refined.inliers, 63u);
  EXPECT_FALSE(refined.inlier[0]);
}

TEST(CameraPose, IsNotFoundFromThreePoints) {
  EXPECT_FALSE(pose_by_ransac(observe(3, 0), {}));
  EXPECT_EQ(refine_pose(observe(3, 0), {}, kTruth).information, Matrix6::Zero());
}

TEST(CameraPose, InformationTellsTheScatterOfThePose) {
  // With the assumed noise, e' information e has mean 6 over many trials.
  Random random({9}, Purpose::odometry);
  double sum = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Observation> noisy = observe(60, 0);
    for (Observation& o : noisy) {
      const Vector3 noise = random.normal3();
      o.u += noise.x();
      o.v += noise.y();
      o.inverse_depth += kInverseDepthSigma * noise.z();
    }
    const RefinedPose pose = refine_pose(noisy, {}, kTruth);
    const Twist e = log_se3(pose.world_from_camera.inverse() * kTruth);
    sum += e.dot(pose.information * e);
  }
  EXPECT_NEAR(sum / kRuns / kInformationScale, 6.0, 1.5);
}

TEST(KeyframeRule, IsDueAtEachThresholdAlone) {
  const FrameRelation same{
      .points = 300, .common = 300, .distance = 0.0, .depth = 2.0, .angle = 0.0, .time = 0.0};
  EXPECT_LT(novelty(same), 1.0);
  FrameRelation view = same;
  view.common = 60;  // of 300: both the share (0.2) and the number (60) are at their thresholds
  EXPECT_NEAR(novelty(view), 1.0, 1e-12);
  view = same;
  view.distance = 0.15 * 2.0;
  EXPECT_NEAR(novelty(view), 1.0, 1e-12);
  view = same;
  view.angle = 30.0 * std::numbers::pi / 180.0;
  EXPECT_NEAR(novelty(view), 2.0, 1e-12);
  view = same;
  view.time = 3.0;
  EXPECT_NEAR(novelty(view), 1.5, 1e-12);
}

TEST(KeyframeRule, ATargetMovesTheThresholdBothWays) {
  EXPECT_EQ(novelty_due(0, 7, 3, 10), 1.0);
  EXPECT_NEAR(novelty_due(10, 1, 0, 101), 1.0, 1e-12);
  EXPECT_NEAR(novelty_due(10, 10, 100, 101), 1.0, 1e-12);
  EXPECT_NEAR(novelty_due(10, 7, 50, 101), std::pow(2.0, 1.5), 1e-12);  // 5.5 planned at half time
  EXPECT_NEAR(novelty_due(10, 4, 50, 101), std::pow(2.0, -1.5), 1e-12);
}

Features two_groups() {
  Features out;
  for (int i = 0; i < 40; ++i) {
    out.points.push_back({});
    for (int byte = 0; byte < 32; ++byte) {
      out.descriptors.push_back(static_cast<std::uint8_t>(i < 20 ? 0x00 : 0xff));
    }
    out.descriptors.back() = static_cast<std::uint8_t>(i % 4);  // differs slightly between features
  }
  return out;
}

Pose step_of(double x) { return {Rotation::Identity(), Vector3(x, 0.0, 0.0)}; }

TEST(NormalisedGap, IsTheGapOverItsVarianceWorkedByHand) {
  // On a straight line rotations do not change x to first order: variances 1 + 1 + 1, gap 3 m.
  const std::vector<Edge> odometry{{0, 1, step_of(1.0)}, {1, 2, step_of(1.0)}};
  const std::vector<double> gaps = normalised_gaps(odometry, {{0, 2, step_of(5.0)}});
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(gaps[0], 9.0 / 3.0 / 6.0, 1e-12);
}

TEST(NormalisedGap, IsOneOnAverageWhenTheInformationIsRight) {
  Random random({3}, Purpose::odometry);
  const auto noise = [&] { return twist(0.01 * random.normal3(), 0.01 * random.normal3()); };
  const Matrix6 information = Matrix6::Identity() * 1e4;
  const Pose step{exp_so3({0.1, 0.2, -0.1}), {0.3, 0.1, -0.2}};
  std::vector<double> gaps;
  for (int run = 0; run < 200; ++run) {
    std::vector<Edge> odometry;
    Pose motion{Rotation::Identity(), Vector3::Zero()};
    for (std::size_t i = 0; i < 8; ++i) {
      odometry.push_back({i, i + 1, step * exp_se3(noise()), information});
      if (i >= 2) motion = motion * step;
    }
    const std::vector<Edge> loop{{2, 8, motion * exp_se3(noise()), information}};
    gaps.push_back(normalised_gaps(odometry, loop)[0]);
  }
  double sum = 0.0;
  for (const double gap : gaps) sum += gap;
  EXPECT_NEAR(sum / 200.0, 1.0, 0.12);  // three standard deviations of the mean
}

// 2 m and 5 m, each with variance 1, differ by 3 m with variance 2; their fusion is 3.5 m.
TEST(RemeasuredGap, IsTheDistanceOverItsVarianceWorkedByHand) {
  const std::vector<Edge> first{{0, 1, step_of(2.0)}, {1, 2, step_of(1.0)}};
  std::vector<Edge> again{{0, 1, step_of(3.5)}, first[1]};
  again[0].information = 2.0 * Matrix6::Identity();
  const std::vector<double> gaps = repeated_measurement_gaps(first, again);
  ASSERT_EQ(gaps.size(), 1u);  // the other edge has no second measurement
  EXPECT_NEAR(gaps[0], 9.0 / 2.0 / 6.0, 1e-5);
  EXPECT_EQ(information_excess(gaps), 1.0);  // too few edges
}

TEST(Descriptors, DistanceIsTheShareOfBits) {
  const Features f = two_groups();
  EXPECT_FLOAT_EQ(descriptor_distance(f, 0, f, 4), 0.0f);
  EXPECT_FLOAT_EQ(descriptor_distance(f, 0, f, 1), 1.0f / 256.0f);
  EXPECT_FLOAT_EQ(descriptor_distance(f, 0, f, 20), 248.0f / 256.0f);
}

TEST(Vocabulary, PutsTheAlikeIntoOneWord) {
  const Features f = two_groups();
  const Vocabulary vocabulary(f, 2, 1, 3);
  EXPECT_EQ(vocabulary.words(), 2u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(vocabulary.word(f, i), vocabulary.word(f, 0));
    EXPECT_NE(vocabulary.word(f, i + 20), vocabulary.word(f, 0));
  }
}

TEST(Bags, AreAlikeByTheRareWordsTheyShare) {
  // Word 0 is in all images and has weight 0; words 1 and 2 have weights log(3 / 2) and log 3.
  const std::vector<Bag> all = bags({{0, 1}, {0, 1, 2}, {0}}, 3);
  ASSERT_EQ(all[0].size(), 1u);
  EXPECT_DOUBLE_EQ(all[0][0].second, 1.0);
  const double rare = std::log(1.5) / (std::log(1.5) + std::log(3.0));
  EXPECT_NEAR(similarity(all[0], all[1]), rare, 1e-12);
  EXPECT_EQ(similarity(all[0], all[2]), 0.0);
  EXPECT_NEAR(similarity(all[1], all[1]), 1.0, 1e-12);
}

TEST(Matching, NearTakesEachFeatureOnceAndTheOneThatLooksLikeIt) {
  const Features all = two_groups();
  Features query;  // one feature of each group in the image centre
  const Camera camera;
  for (const std::size_t i : {std::size_t{0}, std::size_t{20}}) {
    query.points.push_back({static_cast<float>(camera.cx), static_cast<float>(camera.cy), 2.0f});
    query.descriptors.insert(
        query.descriptors.end(), all.descriptor(i), all.descriptor(i) + all.bytes);
  }
  const std::vector<MapPoint> points{{{0.0, 0.0, 2.0}, 0, 1}, {{0.0, 0.0, 2.0}, 0, 0}};
  const std::vector<Match> matches = match_guided(points, all, query, camera, {}, 10.0);
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].a, 1u);  // descriptor row 0 is equal, row 1 differs slightly
  EXPECT_EQ(matches[0].b, 0u);
  const Pose aside{Rotation::Identity(), Vector3(1.0, 0.0, 0.0)};
  EXPECT_TRUE(match_guided(points, all, query, camera, aside, 10.0).empty());
}

TEST(LocalMap, ForgetsWhatNoKeyframeOfTheWindowSaw) {
  Features f = two_groups();
  for (Feature& point : f.points) point.depth = 2.0f;
  LocalMap map;
  map.add(0, 2, f, {}, {}, {});
  EXPECT_EQ(map.points().size(), 40u);
  Features one = f;
  one.points.resize(1);
  one.descriptors.resize(32);
  map.add(1, 2, one, {{7, 0, 0.0f}}, {}, {});
  EXPECT_EQ(map.points().size(), 40u);
  map.add(2, 2, one, {{7, 0, 0.0f}}, {}, {});
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_EQ(map.last_keyframe_of(0), 2u);
  EXPECT_EQ(map.points()[0].row, 0u);
}

TEST(OrderedPipeline, TakesInOrderWhateverTheThreads) {
  std::vector<std::size_t> taken;
  ordered_pipeline<std::size_t>(
      50,
      3,
      4,
      [](std::size_t i) { return i * i; },
      [&](std::size_t i, std::size_t item) {
        EXPECT_EQ(item, i * i);
        taken.push_back(i);
      });
  EXPECT_EQ(taken.size(), 50u);
}

TEST(OrderedPipeline, PassesOnWhatEitherSideThrows) {
  const auto nothing = [](std::size_t, int) {};
  const auto fails = [](std::size_t i) {
    if (i == 5) throw std::runtime_error("made badly");
    return 0;
  };
  EXPECT_THROW(ordered_pipeline<int>(20, 2, 4, fails, nothing), std::runtime_error);
  const auto refuses = [](std::size_t i, int) {
    if (i == 5) throw std::runtime_error("not taken");
  };
  EXPECT_THROW(ordered_pipeline<int>(
                   20, 2, 4, [](std::size_t) { return 0; }, refuses),
               std::runtime_error);
}

}  // namespace
}  // namespace loopbench::tracking_test
