// Tests of depth surfaces, their alignment and the refinement of edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "datasets/derive/odometry.hpp"
#include "datasets/images/dense/refine_by_depth.hpp"
#include "datasets/images/dense/surface.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::dense_test {

using namespace rgbd;

namespace {

Camera toy_camera() {
  return {.width = 160, .height = 120, .fx = 130.0, .fy = 130.0, .cx = 79.5, .cy = 59.5};
}

/// Noise-free depth image of the first `walls` of: a wall at z = 3, a wall at x = 1 and the floor
/// at y = 0.8 (y points down).
DepthImage depth_from(const Pose& world_from_camera, int walls) {
  const Camera camera = toy_camera();
  const double at[] = {3.0, 1.0, 0.8};
  const int axis[] = {2, 0, 1};
  DepthImage out(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vector3 ray = world_from_camera.rotation * camera.back_project(x, y, 1.0);
      double nearest = std::numeric_limits<double>::infinity();
      for (int k = 0; k < walls; ++k) {
        const double t = (at[k] - world_from_camera.translation[axis[k]]) / ray[axis[k]];
        if (t > 0.0) nearest = std::min(nearest, t);
      }
      if (nearest < 10.0) out.at(x, y) = static_cast<float>(nearest);
    }
  }
  return out;
}

Surface surface_from(const Pose& world_from_camera, int walls) {
  return surface_of(
      downsample_depth(depth_from(world_from_camera, walls), toy_camera(), 160, 10.0));
}

Pose still() { return {Rotation::Identity(), Vector3::Zero()}; }

TEST(Surface, BlocksAreTheMeanOfWhatLiesNearTheirMedian) {
  DepthImage depth(6, 2);
  const std::vector<float> upper{1.0f, 1.01f, 0.0f, 2.0f, 1.0f, 3.0f};
  const std::vector<float> lower{1.0f, 1.02f, 0.0f, 0.0f, 1.0f, 1.0f};
  std::ranges::copy(lower, std::ranges::copy(upper, depth.pixels.begin()).out);
  const Camera camera{.width = 6, .height = 2, .fx = 10.0, .fy = 10.0, .cx = 2.5, .cy = 0.5};
  const DownsampledDepth small = downsample_depth(depth, camera, 3, 5.0);
  ASSERT_EQ(small.depth.width, 3);
  ASSERT_EQ(small.depth.height, 1);
  EXPECT_FLOAT_EQ(small.depth.at(0, 0), 1.0075f);
  EXPECT_EQ(small.depth.at(1, 0), 0.0f);  // one of four pixels was measured
  EXPECT_FLOAT_EQ(small.depth.at(2, 0), 1.0f);
  EXPECT_DOUBLE_EQ(small.camera.fx, 5.0);
  EXPECT_DOUBLE_EQ(small.camera.cx, 1.0);  // the principal point stays in the centre
  EXPECT_DOUBLE_EQ(small.camera.cy, 0.0);
  EXPECT_EQ(downsample_depth(depth, camera, 3, 0.5).depth.at(0, 0), 0.0f);  // deeper than depth_max
}

TEST(Surface, UndoesLensDistortion) {
  const Camera camera{
      .width = 101, .height = 101, .fx = 100.0, .fy = 100.0, .cx = 50.0, .cy = 50.0, .k1 = 0.1};
  DepthImage depth(101, 101, 1.0f);
  depth.at(91, 50) = 2.0f;  // (90 - 50) / 100 = 0.4 becomes 0.4 (1 + 0.1 * 0.16): 90.64 px
  const DownsampledDepth straight = downsample_depth(depth, camera, 101, 5.0);
  EXPECT_EQ(straight.depth.at(90, 50), 2.0f);
  EXPECT_EQ(straight.depth.at(50, 50), 1.0f);
  EXPECT_FALSE(straight.camera.distorted());
}

TEST(Surface, NormalsFaceTheCamera) {
  const Surface corner = surface_from(still(), 3);
  const auto normal = [&](int x, int y) -> Vector3 {
    return corner.normals[static_cast<std::size_t>(y * 160 + x)].cast<double>();
  };
  EXPECT_TRUE(normal(60, 40).isApprox(Vector3(0, 0, -1), 1e-4));
  EXPECT_TRUE(normal(155, 40).isApprox(Vector3(-1, 0, 0), 1e-4));
  EXPECT_TRUE(normal(60, 116).isApprox(Vector3(0, -1, 0), 1e-4));
  EXPECT_TRUE(normal(0, 40).isZero());  // no complete patch at the border
}

TEST(Surface, NothingComesOfNothing) {
  const Surface none = surface_of(DownsampledDepth{});
  EXPECT_TRUE(none.points.empty());
  const SurfaceAlignment found = align_surface(none, {}, {still(), Matrix6::Identity()});
  EXPECT_EQ(found.share, 0.0);
  EXPECT_EQ(found.information, Matrix6::Identity());
}

TEST(AlignSurface, FindsThePoseInACorner) {
  const Pose truth{exp_so3({0.02, -0.05, 0.03}), {0.1, -0.04, 0.06}};
  const Surface first = surface_from(still(), 3);
  const Surface second = surface_from(truth, 3);
  const Pose off = truth * Pose{exp_so3({0.02, 0.02, -0.02}), {0.03, -0.02, 0.02}};
  const SurfaceAlignment found = align_surface(second, {{&first, still()}}, {off, Matrix6::Zero()});
  EXPECT_POSE_NEAR(found.world_from_camera, truth, 1e-3, 1e-3);
  EXPECT_GT(found.share, 0.8);
  EXPECT_LT(found.residual_rms, 0.1);
  EXPECT_EQ(found.information.llt().info(), Eigen::Success);
}

// Directions not observed by a wall keep the value and the information of the prior.
TEST(AlignSurface, AWallAloneMovesTheCameraOnlyTowardsIt) {
  const Surface wall = surface_from(still(), 1);
  const PriorPose prior{{Rotation::Identity(), {0.03, 0.02, 0.04}},
                        isotropic_information(0.01 * 0.01, 0.005 * 0.005)};
  const SurfaceAlignment found = align_surface(wall, {{&wall, still()}}, prior);
  EXPECT_NEAR(found.world_from_camera.translation.x(), 0.03, 1e-4);
  EXPECT_NEAR(found.world_from_camera.translation.y(), 0.02, 1e-4);
  EXPECT_NEAR(found.world_from_camera.translation.z(), 0.0, 2e-3);
  EXPECT_NEAR(found.information(0, 0), 1e4, 1.0);
  EXPECT_GT(found.information(2, 2), 1e5);
}

// Two copies of a surface give the same information as one.
TEST(AlignSurface, SurfacesThatShowTheSameCountOnce) {
  const Surface first = surface_from(still(), 3);
  const PriorPose prior{still(), Matrix6::Zero()};
  const SurfaceAlignment once = align_surface(first, {{&first, still()}}, prior);
  const SurfaceAlignment twice =
      align_surface(first, {{&first, still()}, {&first, still()}}, prior);
  EXPECT_TRUE(twice.information.isApprox(once.information, 1e-9));
}

TEST(AlignSurface, SaysThatNothingOverlaps) {
  const Surface ahead = surface_from(still(), 1);
  const Pose back{exp_so3({0.0, M_PI, 0.0}), Vector3::Zero()};
  const SurfaceAlignment found =
      align_surface(ahead, {{&ahead, still()}}, {back, 100.0 * Matrix6::Identity()});
  EXPECT_EQ(found.share, 0.0);
  EXPECT_POSE_NEAR(found.world_from_camera, back, 1e-9, 1e-9);
}

/// Six keyframes that observe the corner; image `missing` cannot be read.
class CornerWalk final : public RgbdSource {
 public:
  explicit CornerWalk(std::size_t missing) : missing_(missing) {
    for (std::size_t k = 0; k < 6; ++k) {
      const auto u = static_cast<double>(k);
      truth_.push_back({u, {exp_so3({0.0, 0.03 * u, 0.01 * u}), {0.04 * u, -0.02 * u, 0.05 * u}}});
    }
  }
  Camera camera() const override { return toy_camera(); }
  std::size_t size() const override { return truth_.size(); }
  double stamp(std::size_t index) const override { return truth_[index].stamp; }
  std::optional<RgbdFrame> read(std::size_t index, std::string& why) const override {
    why = "gone";
    if (index == missing_) return std::nullopt;
    return RgbdFrame{GreyImage(160, 120), depth_from(truth_[index].world_from_body, 3)};
  }
  const Trajectory& reference() const override { return truth_; }
  Provenance provenance() const override { return {}; }

  Pose step(std::size_t from, std::size_t to) const {
    return truth_[from].world_from_body.inverse() * truth_[to].world_from_body;
  }

 private:
  std::size_t missing_;
  Trajectory truth_;
};

constexpr std::size_t kNoneMissing = 99;

Edge rough(const CornerWalk& walk, std::size_t from, std::size_t to) {
  const Pose off{exp_so3({0.01, -0.01, 0.01}), {0.01, 0.01, -0.02}};
  return {from, to, walk.step(from, to) * off, isotropic_information(1e-3, 1e-3)};
}

TrackingResult roughly_tracked(const CornerWalk& walk) {
  TrackingResult out;
  Pose world_from_camera = still();
  for (std::size_t k = 0; k < walk.size(); ++k) {
    if (k > 0) {
      out.odometry.push_back(rough(walk, k - 1, k));
      world_from_camera = world_from_camera * out.odometry.back().from_from_to;
    }
    out.keyframes.push_back({k, walk.stamp(k), world_from_camera, {}});
  }
  return out;
}

RefinedEdges refined(const CornerWalk& walk, const TrackingResult& tracked) {
  return refine_by_depth(walk, tracked, {rough(walk, 0, 5)}, 10.0, [](std::size_t, std::size_t) {});
}

TEST(RefineByDepth, MeasuresStepsAndLoopsAgain) {
  const CornerWalk walk(kNoneMissing);
  const RefinedEdges out = refined(walk, roughly_tracked(walk));
  EXPECT_EQ(out.odometry_refined, 5u);
  EXPECT_EQ(out.closures_refined, 1u);
  for (const Edge& edge : out.odometry) {
    EXPECT_POSE_NEAR(edge.from_from_to, walk.step(edge.from, edge.to), 2e-3, 2e-3);
  }
  ASSERT_EQ(out.closures.size(), 1u);
  EXPECT_POSE_NEAR(out.closures[0].from_from_to, walk.step(0, 5), 2e-3, 2e-3);
}

TEST(RefineByDepth, LeavesGuesses) {
  const CornerWalk walk(kNoneMissing);
  TrackingResult tracked = roughly_tracked(walk);
  tracked.odometry[2].information = isotropic_information(0.25, 0.25);  // edge between two maps
  const RefinedEdges out = refined(walk, tracked);
  EXPECT_EQ(out.odometry_refined, 4u);
  EXPECT_EQ(out.odometry[2].from_from_to.translation, tracked.odometry[2].from_from_to.translation);
  EXPECT_EQ(out.odometry[2].information, tracked.odometry[2].information);
}

TEST(RefineByDepth, LeavesTheEdgesOfAnImageThatCannotBeRead) {
  const CornerWalk walk(3);
  const TrackingResult tracked = roughly_tracked(walk);
  const RefinedEdges out = refined(walk, tracked);
  EXPECT_EQ(out.odometry_refined, 3u);
  for (const std::size_t k : {std::size_t{2}, std::size_t{3}}) {  // edges to and from this keyframe
    EXPECT_EQ(out.odometry[k].information, tracked.odometry[k].information);
  }
}

TEST(FollowOdometry, FramesKeepTheirPlacesBetweenKeyframes) {
  const auto at = [](double x) { return Pose{Rotation::Identity(), {x, 0.0, 0.0}}; };
  TrackingResult tracked;
  tracked.keyframes = {{0, 0.0, at(0.0), {}}, {2, 1.0, at(1.0), {}}, {4, 2.0, at(2.0), {}}};
  tracked.frames = {{0.5, at(0.5)}, {1.25, at(1.25)}};
  update_poses(tracked, {{0, 1, at(2.0)}, {1, 2, at(1.0)}});
  EXPECT_DOUBLE_EQ(tracked.keyframes[1].world_from_camera.translation.x(), 2.0);
  EXPECT_DOUBLE_EQ(tracked.keyframes[2].world_from_camera.translation.x(), 3.0);
  // Moved with the first keyframe it is at 0.5, with the second at 1.5; the stamp is in the middle.
  EXPECT_NEAR(tracked.frames[0].world_from_body.translation.x(), 1.0, 1e-12);
  EXPECT_NEAR(tracked.frames[1].world_from_body.translation.x(), 2.25, 1e-12);
  EXPECT_EQ(tracked.odometry.size(), 2u);
}

}  // namespace
}  // namespace loopbench::dense_test
